#!/usr/bin/env python3
"""Models of the Khronos glTF-Validator's own tests, read by Soffio.

Usage: khronos_validator.py SOFFIO CHECKOUT [--list]

CHECKOUT is a clone of https://github.com/KhronosGroup/glTF-Validator. Beside each of its test models lies a report of what the
validator says. A model is valid if its report has no error. `soffio check` reads each.

The table counts models that are loaded without a word about them, loaded with a warning, and refused. The script exits with 1
where a valid model is refused, an invalid one is loaded without a warning, a model makes the program fail, or a file that is not
truncated is said to be cut short. --list names every model with the first message.
"""

import collections
import json
import pathlib
import subprocess
import sys

# Valid by the validator's report, refused on purpose: minVersion 2.1 asks for a reader of glTF 2.1 (glTF 2.0, section 3.2).
REFUSED_ON_PURPOSE = {"asset/min_version_valid.gltf"}
# Validator codes of a file that ends early.
TRUNCATED = {
    "GLB_UNEXPECTED_END_OF_HEADER", "GLB_UNEXPECTED_END_OF_CHUNK_HEADER", "GLB_UNEXPECTED_END_OF_CHUNK_DATA",
    "GLB_LENGTH_MISMATCH", "INVALID_JSON", "IMAGE_UNEXPECTED_EOS",
}


def read(soffio, model):
    """What Soffio says of a model: its exit code and the messages."""
    run = subprocess.run([soffio, "check", "--quick", "--json", model], capture_output=True, text=True, timeout=60)
    try:
        return run.returncode, json.loads(run.stdout)
    except ValueError:
        return run.returncode, [{"code": "", "message": run.stderr[-300:], "help": ""}]


def main():
    soffio, checkout = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    table, helps, bad = collections.Counter(), collections.Counter(), []
    for report in sorted((checkout / "test").rglob("*.report.json")):
        model = report.with_name(report.name.removesuffix(".report.json"))
        if not model.is_file():
            continue
        issues = json.loads(report.read_text())["issues"]["messages"]
        errors = [issue["code"] for issue in issues if issue["severity"] == 0]
        code, found = read(soffio, model)
        refused = [p for p in found if p["code"].startswith("E")]
        outcome = "refused" if refused else "warned" if found else "silent"
        verdict = "invalid" if errors else "valid"
        table[verdict, outcome] += 1
        name = str(model.relative_to(checkout / "test"))
        wrong = (verdict, outcome) in (("valid", "refused"), ("invalid", "silent"))
        if wrong and not any(name.endswith(known) for known in REFUSED_ON_PURPOSE):
            bad.append(f"{verdict} and {outcome}: {name} {sorted(set(errors))} {found[:1]}")
        if code not in (0, 1, 2) or any(not p["code"] for p in found):
            bad.append(f"fails with {code}: {name} {found[:1]}")
        for problem in refused:
            helps[problem.get("help", "")] += 1
            if "cut short" in problem.get("help", "") and not TRUNCATED & set(errors):
                bad.append(f"not cut short: {name} {problem['message']}")
        if "--list" in sys.argv:
            print(f"{verdict:8}{outcome:8}{name}: {found[0]['message'] if found else ''}")
    print(f"{'':9}{'silent':>8}{'warned':>8}{'refused':>8}")
    for verdict in ("valid", "invalid"):
        print(f"{verdict:9}" + "".join(f"{table[verdict, outcome]:8}" for outcome in ("silent", "warned", "refused")))
    print(f"{len(helps)} remedies; the most frequent one: {helps.most_common(1)}")
    print("\n".join(bad))
    return 1 if bad else 0


sys.exit(main())
