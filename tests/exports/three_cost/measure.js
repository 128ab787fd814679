// Processor time that three.js takes for a picture, on Chromium's software driver, beside `soffio bench --picture`.
//
//     npm install --prefix SCRATCH three
//     target/release/soffio export steel-fish --gltf fish.glb --breath BREATH.wav --seconds 8 --fps 60
//     NODE_PATH=SCRATCH/node_modules node tests/exports/three_cost/measure.js fish.glb 1280x720 [frames [picture.png]]
//
// Counted is what all processes of the browser use (user and system) from the first of the counted pictures to the last,
// which are drawn one after another and each read back, so that none is left out and none is shown. CHROMIUM names the
// program where it is not `chromium`; MSAA and SHADOWS (pcf, vsm) may be set.

"use strict";
const fs = require("fs");
const http = require("http");
const os = require("os");
const path = require("path");
const { execFileSync, spawn } = require("child_process");

const [model, size = "1280x720", frames = "300", picture] = process.argv.slice(2);
const [width, height] = size.split("x");
const { MSAA = "4", SHADOWS = "pcf", CHROMIUM = "chromium" } = process.env;
const three = path.resolve(path.dirname(require.resolve("three")), "..");
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".glb": "model/gltf-binary" };
const TICKS = Number(execFileSync("getconf", ["CLK_TCK"]));

// Processor seconds of a process and of all that it began, those that have ended included.
function seconds(root) {
  const processes = new Map();
  for (const pid of fs.readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const stat = fs.readFileSync(`/proc/${pid}/stat`, "utf8");
      const fields = stat.slice(stat.lastIndexOf(")") + 2).split(" ");
      const used = fields.slice(11, 15).reduce((sum, field) => sum + Number(field), 0);
      processes.set(Number(pid), { parent: Number(fields[1]), used });
    } catch (error) {
      if (error.code !== "ENOENT" && error.code !== "ESRCH") throw error;
    }
  }
  const inside = (pid) => pid === root || (processes.has(pid) && inside(processes.get(pid).parent));
  return [...processes].reduce((sum, [pid, { used }]) => sum + (inside(pid) ? used : 0), 0) / TICKS;
}

function serve(request, response) {
  const url = new URL(request.url, "http://localhost");
  const file =
    url.pathname === "/" ? path.join(__dirname, "page.html")
    : url.pathname === "/run.glb" ? model
    : url.pathname.startsWith("/three/") ? path.join(three, path.normalize(url.pathname.slice(6)))
    : null;
  if (request.method === "GET" && file !== null && fs.existsSync(file)) {
    response.writeHead(200, { "Content-Type": TYPES[path.extname(file)] || "application/octet-stream" });
    fs.createReadStream(file).pipe(response);
    return;
  }
  let body = "";
  request.on("data", (piece) => (body += piece));
  request.on("end", () => {
    const code = request.method === "POST" ? heard(url.pathname, body) : 404;
    response.writeHead(code).end();
  });
}

let before = 0;
function heard(what, body) {
  if (what === "/begin") {
    before = seconds(browser.pid);
  } else if (what === "/end") {
    const cpu = (1e3 * (seconds(browser.pid) - before)) / Number(frames);
    console.log(JSON.stringify({ model: path.basename(model), size, shadows: SHADOWS, frames: Number(frames), cpu_ms: Number(cpu.toFixed(2)), ...JSON.parse(body) }));
  } else if (what === "/picture") {
    if (picture !== undefined) fs.writeFileSync(picture, Buffer.from(body.split(",")[1], "base64"));
    leave(0);
  } else {
    console.error(body);
    leave(1);
  }
  return 200;
}

let browser;
let leaving = false;
const profile = fs.mkdtempSync(path.join(os.tmpdir(), "three-cost-"));
function leave(code) {
  leaving = true;
  browser.once("exit", () => {
    fs.rmSync(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
    process.exit(code);
  });
  browser.kill();
}

const server = http.createServer(serve).listen(0, "127.0.0.1", () => {
  const query = new URLSearchParams({ width, height, frames, msaa: MSAA, shadows: SHADOWS });
  browser = spawn(
    CHROMIUM,
    [
      "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run", "--disable-extensions",
      "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
      "--disable-gpu-watchdog", `--window-size=${width},${height}`, `--user-data-dir=${profile}`,
      `http://127.0.0.1:${server.address().port}/?${query}`,
    ],
    { stdio: "ignore" },
  );
  browser.on("error", (error) => { console.error(`${CHROMIUM}: ${error.message}`); process.exit(1); });
  browser.on("exit", () => { if (!leaving) { console.error("the browser ended by itself"); process.exit(1); } });
});
