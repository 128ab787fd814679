#!/usr/bin/env python3
"""Licence files of the Debian package.

Writes the third-party notices: name, version, licence, repository and licence texts of each package that is linked
into the program `soffio`. With --debian-copyright it writes Debian's machine-readable `copyright` file instead, which
covers Soffio's own files and refers to the notices. With --sbom it writes a software bill of materials in CycloneDX 1.5
(JSON): the packages with version, licence, checksum of their archive, and which depends on which.

The packages are those that `cargo metadata` reaches from `soffio` by normal dependencies, for 64-bit Linux. Cargo
resolves features for the whole workspace there, so a few packages may be listed that the linker leaves out.

The order of the output depends on names, versions and texts only. A file appears whole or not at all.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = "soffio"
PLATFORM = "x86_64-unknown-linux-gnu"
NOTICES = f"/usr/share/doc/{PROGRAM}/THIRD-PARTY"

# Names of files with a licence, or with the authors whom a licence names.
LICENCE_FILE = re.compile(r"(un)?licen[cs]es?(\W|_|$)|(copying|copyright|notices?|authors|patents)(\W|_|$)", re.IGNORECASE)
LICENCE_FOLDER = re.compile(r"licen[cs]es?$", re.IGNORECASE)
NO_TEXT = {".rs", ".yml", ".yaml", ".toml", ".json", ".html", ".png", ".svg"}
# Folders of a package from which nothing gets into a program.
NOT_LINKED = {".git", ".github", "autotests", "benches", "doc", "docs", "examples", "fuzz", "images", "test", "tests"}

# Material other than Rust code that a package brings into the program: what it is, and files of licence text whose
# names do not show it. The other licence files are found by name.
MATERIAL = {
    "epaint_default_fonts": (
        "fonts: Ubuntu Light (Ubuntu font licence 1.0), Noto Emoji (OFL 1.1), Hack (MIT, Bitstream Vera), emoji-icon-font and egui-icons (MIT)",
        ["fonts/*.txt"],
    ),
    "gilrs": ("SDL_GameControllerDB, the button layouts of gamepads (zlib licence)", ["SDL_GameControllerDB/LICENSE"]),
    "regex-syntax": ("tables from the Unicode character database (Unicode licence)", []),
    "wayland-protocols": ("protocol descriptions, from which its code is generated", ["protocols/COPYING"]),
    "wayland-protocols-plasma": (
        "protocol descriptions, from which its code is generated; each file names its licence (blur.xml: LGPL-2.1-or-later)",
        ["plasma-wayland-protocols/LICENSES/*.txt"],
    ),
}

# The MIT licence without a copyright line, for packages that come without a licence file.
MIT = """\
Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated documentation files (the "Software"), to deal in the Software without restriction, including without limitation the rights to use, copy, modify, merge, publish, distribute, sublicense, and/or sell copies of the Software, and to permit persons to whom the Software is furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE."""


class Problem(Exception):
    """What is wrong, and what to do."""


def read_metadata():
    """The workspace and its resolved dependencies, from cargo."""
    command = [os.environ.get("CARGO", "cargo"), "metadata", "--locked", "--format-version", "1", "--filter-platform", PLATFORM]
    try:
        run = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    except OSError as error:
        raise Problem(f"cannot run {command[0]}: {error}. Install Rust, or name cargo in $CARGO.") from None
    if run.returncode != 0:
        raise Problem(f"`{' '.join(command)}` failed:\n{run.stderr.decode(errors='replace').strip()}")
    return json.loads(run.stdout)


def own_package(metadata):
    """The package that is the program."""
    packages = {package["id"]: package for package in metadata["packages"]}
    for member in metadata["workspace_members"]:
        if packages[member]["name"] == PROGRAM:
            return packages[member]
    raise Problem(f"the workspace has no package `{PROGRAM}`")


def linked_packages(metadata):
    """Third-party packages that the program reaches by normal dependencies, by name and version."""
    packages = {package["id"]: package for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    reached, waiting = set(), [own_package(metadata)["id"]]
    while waiting:
        node = waiting.pop()
        if node in reached:
            continue
        reached.add(node)
        for dependency in nodes[node]["deps"]:
            # The kind of a normal dependency is null.
            if any(kind["kind"] is None for kind in dependency["dep_kinds"]):
                waiting.append(dependency["pkg"])
    others = [packages[node] for node in reached if packages[node]["source"] is not None]
    return sorted(others, key=lambda package: (package["name"], version_key(package["version"])))


def version_key(version):
    """Orders 0.9.0 before 0.10.0; ties by the text itself."""
    return [int(number) for number in re.findall(r"\d+", version.split("+")[0])], version


def licence_files(package):
    """Files of a package with licence texts, as paths relative to its folder, sorted."""
    folder = Path(package["manifest_path"]).parent
    found = set()
    for place, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if name.lower() not in NOT_LINKED)
        for name in files:
            named = LICENCE_FILE.match(name) or (Path(place) != folder and LICENCE_FOLDER.match(Path(place).name))
            if named and Path(name).suffix.lower() not in NO_TEXT:
                found.add((Path(place) / name).relative_to(folder).as_posix())
    if package["license_file"]:
        found.add(package["license_file"])
    for pattern in MATERIAL.get(package["name"], ("", []))[1]:
        matches = {path.relative_to(folder).as_posix() for path in folder.glob(pattern)}
        if not matches:
            raise Problem(f"{title(package)} has no {pattern} any more. Correct MATERIAL in {Path(__file__).name}.")
        found |= matches
    # Where there is a choice, Soffio does not use a package under the GPL.
    if " OR " in expression(package):
        found = {path for path in found if "GPL" not in path.upper()}
    return sorted(found)


def title(package):
    """Name and version."""
    return f"{package['name']} {package['version']}"


def expression(package):
    """The licence as an SPDX expression, or nothing. Old manifests write a stroke for OR."""
    return re.sub(r"\s*/\s*", " OR ", package["license"] or "")


def read_text(path):
    """A text file with plain line ends and no blank lines around it."""
    data = path.read_bytes()
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    lines = [line.rstrip() for line in text.replace("\r\n", "\n").replace("\r", "\n").replace("\f", "\n").split("\n")]
    return "\n".join(lines).strip("\n")


def standard_texts(package):
    """Licence texts for a package that comes without a licence file, as (label, text)."""
    named = set(re.findall(r"[A-Za-z0-9.+-]+", expression(package)))
    texts = []
    if "Apache-2.0" in named:
        texts.append(("Apache-2.0, standard text", read_text(ROOT / "LICENSE-APACHE")))
    if "MIT" in named:
        texts.append(("MIT, standard text", textwrap.fill(MIT, 100, replace_whitespace=False)))
    return texts


def collect(packages):
    """Entries of all packages, and the texts that they refer to. Texts that differ only in white space are one."""
    entries, texts, numbers, problems = [], [], {}, []

    def number_of(text, user):
        key = " ".join(text.split())
        if key not in numbers:
            numbers[key] = len(texts)
            texts.append((text, []))
        users = texts[numbers[key]][1]
        if user not in users:
            users.append(user)
        return numbers[key] + 1

    for package in packages:
        name, folder = title(package), Path(package["manifest_path"]).parent
        files = licence_files(package)
        if not files and not expression(package):
            problems.append(f"{name} has neither a licence expression nor a licence file ({folder})")
            continue
        parts = [(path, read_text(folder / path)) for path in files]
        # Licence files deeper down cover only what lies there.
        alone = not any("/" not in path for path in files)
        if alone:
            parts += standard_texts(package)
        parts = [(label, text) for label, text in parts if text]
        if not parts:
            problems.append(f"{name} is under {expression(package)}, but has no licence file, and {Path(__file__).name} has no standard text of that licence")
            continue
        entry = [name, f"    licence:    {expression(package) or 'see the texts'}"]
        if package["repository"]:
            entry.append(f"    repository: {package['repository']}")
        if alone and package["authors"]:
            entry.append(f"    authors:    {', '.join(package['authors'])}")
        if package["name"] in MATERIAL:
            entry.append(f"    contains:   {MATERIAL[package['name']][0]}")
        labels = [f"[{number_of(text, name)}] {label}" for label, text in parts]
        entry.append(f"    texts:      {', '.join(labels)}")
        entries.append("\n".join(entry))
    if problems:
        raise Problem("\n".join(problems) + "\nAsk the authors for a licence, or replace the package.")
    return entries, texts


def heading(text, line):
    """A heading, underlined."""
    return f"{text}\n{line * len(text)}"


def notices(metadata):
    """The third-party notices."""
    packages = linked_packages(metadata)
    entries, texts = collect(packages)
    head = [
        f"The program `{PROGRAM}` is built with the {len(packages)} Rust packages listed here, and contains fonts and data that some of "
        "them bring. Soffio changes none of them. Their source code is in the repository named beside each, and in the registry of Rust packages "
        "under its name and version.",
        "Where a licence offers a choice (OR), Soffio uses the package under the MIT, Apache-2.0 or another permissive licence, never "
        "under the GPL. A number in brackets refers to the texts at the end.",
        "The program also contains the Rust standard library: MIT OR Apache-2.0, by the Rust project developers.",
        "Exhibits, models, pictures, sounds and shaders are Soffio's own, under Soffio's licence.",
    ]
    parts = [heading(f"Third-party notices of Soffio {own_package(metadata)['version']}", "=")]
    parts += [textwrap.fill(paragraph, 100) for paragraph in head]
    parts += [heading("Packages", "-"), *entries, heading("Texts", "-")]
    for number, (text, users) in enumerate(texts, 1):
        used_by = textwrap.fill(f"[{number}] {', '.join(users)}", 100, subsequent_indent="    ", break_on_hyphens=False)
        parts += [used_by, textwrap.indent(text, "    ", lambda line: line.strip())]
    return "\n\n".join(parts) + "\n"


def debian_copyright(metadata):
    """Debian's machine-readable copyright file."""
    own = own_package(metadata)
    lines = read_text(ROOT / "LICENSE-MIT").split("\n")
    owner = next((found[1] for line in lines if (found := re.match(r"Copyright \(c\) (.+)", line))), None)
    if owner is None or own["license"] != "MIT OR Apache-2.0":
        raise Problem("LICENSE-MIT has no line `Copyright (c) …`, or the package's licence is no longer `MIT OR Apache-2.0`")
    permission = "\n".join(lines).split(f"Copyright (c) {owner}\n", 1)[1].strip("\n")
    body = "\n".join(f" {line}" if line.strip() else " ." for line in permission.split("\n"))
    return f"""\
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: {own["name"]}
Source: {own["repository"]}
Comment: The program contains third-party packages and fonts.
 {NOTICES} lists them with their licences.

Files: *
Copyright: {owner}
License: Expat or Apache-2.0

License: Expat
{body}

License: Apache-2.0
 On Debian systems the full text of the Apache License 2.0 is in
 /usr/share/common-licenses/Apache-2.0.
"""


def archive_checksums():
    """SHA-256 of the registry's archive of each package, from Cargo.lock, by name and version."""
    found, package = {}, {}
    for line in (ROOT / "Cargo.lock").read_text(encoding="utf-8").split("\n"):
        if line == "[[package]]":
            package = {}
        elif entry := re.match(r'(name|version|checksum) = "(.+)"$', line):
            package[entry[1]] = entry[2]
            if entry[1] == "checksum":
                found[package["name"], package["version"]] = entry[2]
    return found


def sbom(metadata):
    """A software bill of materials in CycloneDX 1.5. It has no time and no random number, so that it can be made again."""
    own, packages, checksums = own_package(metadata), linked_packages(metadata), archive_checksums()
    names = {package["id"]: f"pkg:cargo/{package['name']}@{package['version']}" for package in packages}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    workspace = set(metadata["workspace_members"])

    def component(package):
        entry = {
            "type": "library",
            "bom-ref": names[package["id"]],
            "name": package["name"],
            "version": package["version"],
            "purl": names[package["id"]],
            "scope": "required",
        }
        if expression(package):
            # A single licence is an id; everything else is an expression.
            single = re.fullmatch(r"[A-Za-z0-9.+-]+", expression(package))
            entry["licenses"] = [{"license": {"id": single[0]}}] if single else [{"expression": expression(package)}]
        else:
            entry["licenses"] = [{"license": {"name": f"see {package['license_file']}"}}]
        checksum = checksums.get((package["name"], package["version"]))
        if checksum is None:
            raise Problem(f"Cargo.lock has no checksum of {title(package)}. Take it from the registry.")
        entry["hashes"] = [{"alg": "SHA-256", "content": checksum}]
        if package["repository"]:
            entry["externalReferences"] = [{"type": "vcs", "url": package["repository"]}]
        return entry

    def used_by(start):
        """Third-party packages that a package uses, directly or through Soffio's own crates."""
        used, seen, waiting = set(), set(), [start]
        while waiting:
            for dependency in nodes[waiting.pop()]["deps"]:
                node = dependency["pkg"]
                if node in seen or not any(kind["kind"] is None for kind in dependency["dep_kinds"]):
                    continue
                seen.add(node)
                if node in workspace:
                    waiting.append(node)
                elif node in names:
                    used.add(names[node])
        return sorted(used)

    program = f"pkg:generic/{PROGRAM}@{own['version']}"
    bill = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {
            "component": {
                "type": "application",
                "bom-ref": program,
                "name": PROGRAM,
                "version": own["version"],
                "purl": program,
                "licenses": [{"expression": own["license"]}],
            }
        },
        "components": [component(package) for package in packages],
        "dependencies": [{"ref": program, "dependsOn": used_by(own["id"])}]
        + [{"ref": names[package["id"]], "dependsOn": used_by(package["id"])} for package in packages],
    }
    return json.dumps(bill, indent=1, ensure_ascii=False) + "\n"


def write_whole(path, text):
    """Writes a file in one piece: a failure leaves what was there before."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
        os.chmod(name, 0o644)
        os.replace(name, path)
    except BaseException:
        os.unlink(name)
        raise


def main():
    parser = argparse.ArgumentParser(
        description=__doc__,
        epilog="example:\n  kiosk-config/debian/notices.py -o out/package/THIRD-PARTY\n\nexit codes: 0 done, 1 a package has no licence, or cargo failed, 2 usage",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("-o", "--output", metavar="FILE", type=Path, help="write to FILE instead of the standard output")
    parser.add_argument("--debian-copyright", action="store_true", help="write Debian's `copyright` file instead of the notices")
    parser.add_argument("--sbom", action="store_true", help="write a software bill of materials (CycloneDX, JSON) instead of the notices")
    given = parser.parse_args()
    try:
        metadata = read_metadata()
        make = debian_copyright if given.debian_copyright else sbom if given.sbom else notices
        text = make(metadata)
        if given.output:
            write_whole(given.output, text)
        else:
            sys.stdout.buffer.write(text.encode("utf-8"))
    except (Problem, OSError) as problem:
        sys.exit(f"notices: {problem}")


if __name__ == "__main__":
    main()
