#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the pages point at is there: links and their headings, pictures, files named in code marks,
and the functions that a page says a file
holds.

    check_docs.py ROOT          exits with 1 and a line for each thing that is not there
    check_docs.py --self-test   shows that each kind is found
"""

import re
import sys
import tempfile
from pathlib import Path

LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`\n]+)`")
PATH = re.compile(
    r"(?:src|shaders|texgen|tests|docs|scripts|terrains|vehicles|cmake)/[\w./*{},-]+\Z"
)
FILE = r"[\w./*{},]+\.(?:cpp|h|glsl|vert|frag|comp|tesc|tese|py)"
NAMED = re.compile(rf"`({FILE})`: ((?:`[\w:]+`[,; ()]*)+)")  # `file`: `name`, `another`
MADE = re.compile(r"\A(?:build|out)/")  # by the build, not in the tree


def anchor(heading):
    """As pages are shown on the web: lower case, words joined by dashes."""
    text = re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", r"\1", heading.strip().lower())
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def headings(page):
    text = re.sub(r"^(```|~~~).*?^\1", "", page.read_text(encoding="utf-8"), flags=re.S | re.M)
    return {anchor(line.lstrip("#")) for line in text.split("\n") if line.startswith("#")}


def spread(path):
    """`a/{b,c}.h` as a/b.h and a/c.h."""
    match = re.search(r"\{([^{}]*)\}", path)
    if not match:
        return [path]
    return [
        p
        for part in match.group(1).split(",")
        for p in spread(path[: match.start()] + part + path[match.end() :])
    ]


def files_of(root, path, beside):
    """A file as a page names it: from the root, or by its name alone beside the one named before
    it."""
    found = [file for one in spread(path) for file in root.glob(one)]
    return found or [file for one in spread(path) for file in beside.glob(one)]


def missing_names(root, line):
    """Names that the file before them does not hold."""
    for match in NAMED.finditer(line):
        path, names = match.groups()
        earlier = [
            files[0].parent
            for other in re.findall(rf"`({FILE})`", line[: match.start()])
            if "/" in other and (files := files_of(root, other, root))
        ]
        files = files_of(root, path, earlier[-1] if earlier else root)
        if not files:
            yield path
            continue
        text = "".join(file.read_text(encoding="utf-8") for file in files)
        for name in re.findall(r"`([\w:]+)`", names):
            if not re.search(rf"\b{re.escape(name.split('::')[-1])}\b", text):
                yield f"{path}: {name}"


def missing(root, page):
    text = page.read_text(encoding="utf-8")
    for number, line in enumerate(text.split("\n"), 1):
        for target in LINK.findall(line):
            if "://" in target or target.startswith("mailto:"):
                continue
            name, _, heading = target.partition("#")
            file = (page.parent / name).resolve() if name else page
            if not file.exists():
                yield number, target
            elif heading and file.suffix == ".md" and heading not in headings(file):
                yield number, target
        for what in missing_names(root, line):
            yield number, what
        for code in CODE.findall(line):
            if not PATH.match(code) or MADE.match(code):
                continue
            for path in spread(code.rstrip("/.,")):
                if not any(root.glob(path)) and not any(root.glob(path + ".*")):
                    yield number, code


def check(root):
    pages = [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]
    return [
        f"{page.relative_to(root)}:{number}: {what} is not there"
        for page in pages
        if page.exists()
        for number, what in missing(root, page)
    ]


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "docs").mkdir()
        (root / "src").mkdir()
        (root / "src/a.h").write_text("int f();")
        (root / "src/a.cpp").write_text("")
        (root / "src/b.cpp").write_text("int g() { return 0; }")
        (root / "docs/b.md").write_text("# What it is\n## A `word`, and more\n")
        (root / "README.md").write_text(
            "[b](docs/b.md#what-it-is) [c](docs/b.md#a-word-and-more) `src/a.h` `src/a.{h,cpp}` `src/*.h` `src/a`\n`src/a.h`: `f`, `b.cpp`: `g`\n"
        )
        assert check(root) == [], check(root)
        (root / "README.md").write_text(
            "[b](docs/c.md)\n[b](docs/b.md#nothing)\n`src/b.h`\n`src/{a,b}.h`\n![p](p.png)\n`src/a.h`: `f`, `g`\n"
        )
        assert [word.split(":")[1] for word in check(root)] == [
            "1",
            "2",
            "3",
            "4",
            "5",
            "6",
        ], check(root)
    print("six kinds found, and none where all is there")


def main():
    if sys.argv[1] == "--self-test":
        self_test()
        return 0
    said = check(Path(sys.argv[1]).resolve())
    print("\n".join(said) or "all is there")
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main())
