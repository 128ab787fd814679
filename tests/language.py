#!/usr/bin/env python3
"""Reads what is written in this repository and says what a newcomer would stumble over.

  tests/language.py                 names and prose of the whole repository; fails where a bar is missed
  tests/language.py PATH …          of these files and folders alone
  tests/language.py --names PATH …  only names          tests/language.py --prose PATH …  only sentences
  tests/language.py --all …         every finding, not only the first of each kind
  tests/language.py --items SEED    60 public items drawn with this seed and their documentation, to be read by somebody

Names: no identifier, file or phrase of the left column of tests/glossary.toml, and each term to be found leads to its file.
Sentences: of all Markdown, doc comments and messages; 20 words on average at most, none over 40.

A sentence ends at `.`, `?` or `!`, at the end of a paragraph and of a list item. Code, tables, headings and formulas
are no sentences. A piece of code within a sentence counts as one word.
"""
import fnmatch, os, random, re, subprocess, sys, tomllib

MEAN, LONGEST = 20, 40
# Fewer words than this are a label, not a message.
MESSAGE = 5
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)

# ---- files -----------------------------------------------------------------------------------------------------------


def files(paths):
    """Files under version control, or new, below these paths. Test inputs and this list's own words are left out."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *paths],
        cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    out = ("tests/cases/", "tests/fuzz/seeds/", "tests/fuzz/found/", "tests/glossary.toml", "tests/language.py")
    return sorted(f for f in set(listed) if f and not f.startswith(out) and os.path.isfile(os.path.join(ROOT, f)))


# ---- Rust: code, comments and strings apart --------------------------------------------------------------------------

TOKEN = re.compile(
    r'(?P<comment>//[^\n]*)'
    r'|(?P<block>/\*.*?\*/)'
    r'|(?P<raw>b?r(?P<hashes>#*)".*?"(?P=hashes))'
    r'|(?P<string>b?"(?:\\.|[^"\\])*")'
    r"|(?P<char>b?'(?:\\(?:x..|u\{[^}]*\}|.)|[^'\\\n])')"
    r'|(?P<name>[A-Za-z_][A-Za-z0-9_]*)', re.S)


def tokens(text):
    """Kind, text and line of each comment, string and name of a Rust file."""
    line, at = 1, 0
    for found in TOKEN.finditer(text):
        line += text.count("\n", at, found.start())
        at = found.start()
        kind = found.lastgroup if found.lastgroup != "hashes" else "raw"
        yield kind, found.group(), line


def comments(text):
    """Comment paragraphs of a Rust file: (first line, is it documentation, lines without their slashes)."""
    block, last, style = [], None, None
    for kind, found, line in tokens(text):
        if kind != "comment":
            continue
        new = re.match(r"//[/!]?", found).group()
        if block and (line != last + 1 or new != style):
            yield first, style != "//", block
            block = []
        if not block:
            first = line
        block.append(found[len(new):].removeprefix(" "))
        last, style = line, new
    if block:
        yield first, style != "//", block


def messages(text):
    """Strings of a Rust file that are sentences: line and words, placeholders as one word each."""
    for kind, found, line in tokens(text):
        if kind not in ("string", "raw"):
            continue
        inner = found[found.index('"') + 1:found.rindex('"')]
        inner = re.sub(r"\\\n\s*", "", inner).replace("\\n", "\n").replace('\\"', '"')
        if kind == "raw" and re.search(r"[{};]\s*\n|^\s*\[", inner):
            continue
        for paragraph in re.split(r"\n", re.sub(r"\{[^{}]*\}", "X", inner)):
            if len(words(paragraph)) >= MESSAGE and re.search(r"[a-z]{2,} [a-z]{2,}", paragraph):
                yield line, paragraph


# ---- sentences -------------------------------------------------------------------------------------------------------

ITEM = re.compile(r"^\s*(?:[-*+•]|\d+[.)])\s+")


def words(sentence):
    return [w for w in sentence.split() if re.search(r"[A-Za-z0-9]", w)]


def paragraphs(lines, first=1):
    """Paragraphs and list items of Markdown: (line, text). Code, tables, headings, comments and formulas are left out."""
    part, start, fenced = [], first, False
    for number, line in enumerate(lines, first):
        if re.match(r"\s*(```|~~~)", line):
            fenced = not fenced
            ends, keep = True, False
        else:
            ends = not line.strip() or bool(ITEM.match(line)) or bool(re.match(r"\s*(#|\||<|>|\[[^\]]*\]:)", line))
            keep = not fenced and bool(line.strip()) and not re.match(r"\s*(#+ |\||<|\[[^\]]*\]:)|    ", line)
        if ends and part:
            yield start, " ".join(part)
            part = []
        if keep:
            if not part:
                start = number
            part.append(ITEM.sub("", line).strip().lstrip("> "))
    if part:
        yield start, " ".join(part)


ABBREVIATIONS = re.compile(r"\b(e\.g|i\.e|cf|vs|Eq|Fig|No|approx|St|Dr|pp|Vol|al|etc)\.")


def sentences(text):
    text = re.sub(r"`+[^`]*`+", "code", text)
    text = re.sub(r"!?\[([^\]]*)\](\([^)]*\)|\[[^\]]*\])?", r"\1", text)
    text = re.sub(r"https?://\S+", "link", text)
    text = ABBREVIATIONS.sub(lambda m: m.group().replace(".", ""), text)
    for sentence in re.split(r"(?<=[.?!])[)\"'”*_]*\s+(?=[\"'“(*_]*[A-Z0-9\u0370-\u03ff|√√‖½∑])|(?<=[.?!]) +(?=code)", text):
        # A formula is no sentence.
        if sentence and len(words(sentence)) and not (re.search(r"[=≤≥∑·×]", sentence) and not re.search(r"[a-z]{3,} [a-z]{2,} ", sentence)):
            yield sentence.strip()


def prose(path):
    """(line, kind, paragraph) of all that is to be read in a file."""
    text = open(os.path.join(ROOT, path), encoding="utf-8").read()
    if path.endswith(".md"):
        for line, paragraph in paragraphs(text.split("\n")):
            yield line, "Markdown", paragraph
    elif path.endswith(".rs"):
        for first, documents, block in comments(text):
            for line, paragraph in paragraphs(block, first):
                yield line, "docs" if documents else "comment", paragraph
        if not re.match(r"tests/|.*/tests/", path):
            for line, message in messages(text):
                yield line, "message", message


# ---- the two tests ---------------------------------------------------------------------------------------------------


def check_prose(listed, everything):
    count = total = 0
    long, by_file = [], {}
    for path in listed:
        if not path.endswith((".rs", ".md")):
            continue
        for line, kind, paragraph in prose(path):
            if kind == "comment":
                continue
            for sentence in sentences(paragraph):
                n = len(words(sentence))
                count, total = count + 1, total + n
                one = by_file.setdefault(path, [0, 0])
                one[0] += 1
                one[1] += n
                if n > LONGEST:
                    long.append((n, path, line, sentence))
    mean = total / max(count, 1)
    for n, path, line, sentence in sorted(long, reverse=True)[:None if everything else 20]:
        print(f"{path}:{line}: {n} words: {sentence}")
    if everything:
        for path, (number, sum_) in sorted(by_file.items()):
            if sum_ / number > MEAN:
                print(f"{path}: {sum_ / number:.1f} words a sentence ({number} sentences)")
    print(f"sentences: {count}, {mean:.1f} words on average (at most {MEAN}), {len(long)} over {LONGEST} words (at most 0)")
    return mean <= MEAN and not long


def check_names(listed, everything):
    rules = tomllib.load(open(os.path.join(HERE, "glossary.toml"), "rb"))
    names = [(pattern, rule) for rule in rules["name"] for pattern in rule["old"]]
    plain = {p: rule for p, rule in names if not re.search(r"[*?\[]", p)}
    globs = [(re.compile(fnmatch.translate(p)), rule) for p, rule in names if re.search(r"[*?\[]", p)]
    phrases = [(re.compile(r"\b(?:" + old + r")\b"), rule) for rule in rules["phrase"] for old in rule["old"]]
    found = {}
    known = {}

    def applies(rule, path):
        return path.startswith(tuple(rule.get("in", [""]))) and not path.startswith(tuple(rule.get("except", ["\0"])))

    def look_up(name):
        if name not in known:
            known[name] = ([plain[name]] if name in plain else []) + [rule for glob, rule in globs if glob.match(name)]
        return known[name]

    def note(old, rule, path, line):
        found.setdefault((old, rule["new"]), []).append(f"{path}:{line}")

    for path in listed:
        stem = os.path.basename(path).split(".")[0]
        for rule in look_up(stem):
            if path.endswith((".rs", ".wgsl", ".sh")) and applies(rule, path):
                note(stem, rule, path, 0)
        if path.endswith((".rs", ".wgsl")):
            for kind, name, line in tokens(open(os.path.join(ROOT, path), encoding="utf-8").read()):
                if kind == "name":
                    for rule in look_up(name):
                        if applies(rule, path):
                            note(name, rule, path, line)
        if path.endswith((".rs", ".md")):
            for line, _, paragraph in prose(path):
                spoken = re.sub(r"`[^`]*`", "", paragraph)
                for phrase, rule in phrases:
                    if applies(rule, path) and (old := phrase.search(spoken)):
                        note(f"“{old.group()}”", rule, path, line)
    for (old, new), where in sorted(found.items(), key=lambda one: -len(one[1])):
        print(f"{old} ({len(where)}) → {new}: " + " ".join(where[:None if everything else 3]))
    number = sum(map(len, found.values()))
    print(f"names: {number} uses of {len(found)} old words (at most 0)")
    return not found


def check_terms():
    """Each term that somebody would search for is in the name of its file, or of a type or function in it."""
    good = True
    for one in tomllib.load(open(os.path.join(HERE, "glossary.toml"), "rb")).get("find", []):
        parts = one["term"].lower().split()
        path = os.path.join(ROOT, one["file"])
        text = open(path, encoding="utf-8").read() if os.path.isfile(path) else ""
        names = [one["file"]] + re.findall(r"\b(?:struct|enum|trait|fn|type|mod|pub(?= \w+:)) (\w+)", text)
        if not text or not any("".join(parts) in name.lower().replace("_", "").replace("-", "") for name in names):
            print(f"“{one['term']}” does not lead to {one['file']}")
            good = False
    return good


def draw_items(seed, number=60):
    """Public items and their documentation, drawn at random."""
    items = []
    for path in files(["src"]):
        if not path.endswith(".rs") or "/tests/" in path or "/examples/" in path:
            continue
        documentation = []
        for number_of_line, line in enumerate(open(os.path.join(ROOT, path), encoding="utf-8").read().split("\n"), 1):
            found = re.match(r"\s*///\s?(.*)", line)
            if found:
                documentation.append(found.group(1))
            elif re.match(r"\s*pub (?:const fn|fn|struct|enum|trait|const|type|static|\w+:)", line):
                items.append((f"{path}:{number_of_line}", " ".join(documentation), line.strip().rstrip("{").strip()))
                documentation = []
            elif not re.match(r"\s*#\[", line):
                documentation = []
    for where, documentation, item in random.Random(seed).sample(items, number):
        print(f"{where}\n    {item}\n    {documentation}")


def main():
    arguments = sys.argv[1:]
    if arguments[:1] == ["--items"]:
        draw_items(int(arguments[1]))
        return 0
    if "-h" in arguments or "--help" in arguments:
        print(__doc__)
        return 0
    options = {a for a in arguments if a.startswith("--")}
    listed = files([os.path.relpath(os.path.abspath(a), ROOT) for a in arguments if not a.startswith("--")] or ["."])
    everything = "--all" in options
    good = True
    if "--prose" not in options:
        good &= check_names(listed, everything) & check_terms()
    if "--names" not in options:
        good &= check_prose(listed, everything)
    return 0 if good else 1


sys.exit(main())
