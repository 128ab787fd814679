// The Khronos validator on models: of the exhibits, or those that are named. Ends with 1 where one has an error or a warning.
//
//     npm install --prefix SCRATCH gltf-validator
//     NODE_PATH=SCRATCH/node_modules node tests/exports/validate.js [FILE.glb …]
//
// Hints and infos (empty nodes are the marks that sidecars name) are counted, and bad only where they are errors.

"use strict";
const fs = require("fs");
const path = require("path");
const validator = require("gltf-validator");

const EXHIBITS = path.join(__dirname, "..", "..", "exhibits");

function models() {
  const folders = fs.readdirSync(EXHIBITS).map((name) => path.join(EXHIBITS, name));
  const inside = (folder) => (fs.statSync(folder).isDirectory() ? fs.readdirSync(folder) : []);
  return folders.flatMap((f) => inside(f).filter((name) => name.endsWith(".glb")).map((name) => path.join(f, name)));
}

async function main() {
  const named = process.argv.slice(2);
  let bad = 0;
  for (const file of named.length > 0 ? named : models()) {
    const { issues } = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { maxIssues: 0 });
    const codes = {};
    for (const { code } of issues.messages) codes[code] = (codes[code] || 0) + 1;
    const { numErrors, numWarnings, numInfos } = issues;
    console.log(`${path.basename(file)}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos`, codes);
    if (numErrors + numWarnings > 0) bad += 1;
  }
  process.exitCode = bad > 0 ? 1 : 0;
}

main();
