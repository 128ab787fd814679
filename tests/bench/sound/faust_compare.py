#!/usr/bin/env python3
"""Partials x real time of Faust's pm.modeFilter beside our bank, one core, thread CPU time, best of the rounds.

By hand: needs faust and g++ (Debian: apt-get install faust g++) and a release build of the program. Both run in turns, so that
the ratio holds on a machine that has other work.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

DSP = """
import("stdfaust.lib");
N = {count};
// The same for all: frequencies from 40 Hz to 16 kHz, T60 from 2 s to 20 s.
mode(i) = pm.modeFilter(40 * pow(400, (i + 0.37) / N), 2 * pow(10, (i * 7 % N) / N), 1.0 / N);
process = _ <: par(i, N, mode(i)) :> _;
"""

HARNESS = r"""
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>
#define FAUSTFLOAT float
#define __FAUST_INLINE__ inline
struct Meta { void declare(const char*, const char*) {} };
struct UI {
  void openVerticalBox(const char*) {}
  void closeBox() {}
  void declare(FAUSTFLOAT*, const char*, const char*) {}
};
struct dsp { virtual ~dsp() {} };
#include "mode.inc"
static double now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}
int main(int, char** argv) {
  const int count = atoi(argv[1]), block = atoi(argv[2]), blocks = 48000 * 4 / block;
  auto* d = new mydsp();
  d->init(48000);
  std::vector<float> in(block), out(block);
  float* ins[1] = {in.data()};
  float* outs[1] = {out.data()};
  double sum = 0;
  in[0] = 1;
  const double start = now();
  for (int b = 0; b < blocks; b++) {
    d->compute(block, ins, outs);
    sum += out[0];
    in[0] = 0;
  }
  printf("%g %g\n", count * double(blocks) * block / 48000 / (now() - start), sum);
}
"""

FORMS = {"scalar": [], "vector": ["-vec", "-lv", "1", "-vs", "32"]}


def build(folder: Path, form: str, count: int) -> Path:
    """Compiles one form and answers with its program."""
    here = folder / form
    here.mkdir()
    (here / "mode.dsp").write_text(DSP.format(count=count))
    command = ["faust", *FORMS[form], "-cn", "mydsp", "-o", str(here / "mode.inc"), str(here / "mode.dsp")]
    subprocess.run(command, check=True)
    (here / "main.cpp").write_text(HARNESS)
    program = here / "main"
    flags = ["-O3", "-march=native", "-ffast-math", "-w"]
    subprocess.run(["g++", *flags, "-o", str(program), str(here / "main.cpp")], check=True)
    return program


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--soffio", default="../../../target/release/soffio", help="the release build")
    parser.add_argument("--partials", type=int, default=64)
    parser.add_argument("--blocks", type=int, nargs="+", default=[64, 512])
    parser.add_argument("--rounds", type=int, default=3)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        programs = {form: build(Path(folder), form, args.partials) for form in FORMS}
        best: dict[str, float] = {}
        for _ in range(args.rounds):
            lines = subprocess.run([args.soffio, "bench", "--sound", "--json"], check=True, capture_output=True, text=True)
            for row in map(json.loads, lines.stdout.splitlines()):
                if "level" in row:
                    key = f"soffio {row['level']}, {row['partials']} partials"
                    best[key] = max(best.get(key, 0.0), row["partials_real_time"])
            for form, program in programs.items():
                for block in args.blocks:
                    command = [str(program), str(args.partials), str(block)]
                    found = subprocess.run(command, check=True, capture_output=True, text=True)
                    key = f"faust {form}, block {block}"
                    best[key] = max(best.get(key, 0.0), float(found.stdout.split()[0]))
    faust = max(rate for key, rate in best.items() if key.startswith("faust"))
    for key, rate in best.items():
        print(f"{key:<36} {rate:>12.0f}   {rate / faust:>6.1f} x the best of Faust")


if __name__ == "__main__":
    main()
