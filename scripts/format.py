#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lays out the sources: C++ and GLSL by clang-format 14, Python by ruff, both at 100 columns;
pages by mdformat, at 120.

    build/venv/bin/python scripts/format.py             lays out every tracked source
    build/venv/bin/python scripts/format.py FILE...     only these
    build/venv/bin/python scripts/format.py --check     changes nothing; exits with 1 and the names
                                                        of the files that would change

The tools are in tests/requirements.txt at the versions that CI uses: another version lays out
differently. They are looked for beside this Python first, then in the PATH."""

import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
GLSL = (".glsl", ".vert", ".tesc", ".tese", ".frag", ".comp")
CURLY = (".cpp", ".h", *GLSL)


def tool(name):
    beside = Path(sys.executable).parent / name
    found = str(beside) if beside.is_file() else shutil.which(name)
    if not found:
        sys.exit(f"{name}: not found, expected beside {sys.executable} or in the PATH")
    return found


def run(command, text, path):
    done = subprocess.run(command, input=text, capture_output=True, text=True, cwd=ROOT)
    if done.returncode:
        sys.exit(f"{path}: {command[0]} refused it: {done.stderr.strip()}")
    return done.stdout


def laid_out(path, text):
    """The text of the file `path` as it should be."""
    if path.suffix == ".py":
        name = ["--stdin-filename", str(path)]
        return run([tool("ruff"), "format", "--quiet", *name, "-"], text, path)
    if path.suffix == ".md":
        return run([tool("mdformat"), "--wrap", "120", "--compact-tables", "-"], text, path)
    # clang-format takes GLSL for C++, and knows its suffixes only under a name of C++'s.
    name = f"--assume-filename={path.with_suffix('.cpp') if path.suffix in GLSL else path}"
    text = run([tool("clang-format"), "--style=file", name], text, path)
    if path.suffix in GLSL:  # the name of a block of inputs or outputs stays at its brace
        text = re.sub(r"^\}\n(\w+(?:\[\])?;)$", r"} \1", text, flags=re.M)
    return text


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--check"]
    listed = subprocess.run(["git", "ls-files"], capture_output=True, text=True, cwd=ROOT).stdout
    paths = [Path(argument).resolve().relative_to(ROOT) for argument in arguments]
    paths = paths or [Path(name) for name in listed.splitlines()]
    paths = [
        path for path in paths if path.suffix in (*CURLY, ".py", ".md") and (ROOT / path).is_file()
    ]
    with ThreadPoolExecutor() as pool:
        texts = [(ROOT / path).read_text(encoding="utf-8") for path in paths]
        wanted = list(pool.map(laid_out, paths, texts))
    changed = [(path, new) for path, old, new in zip(paths, texts, wanted) if old != new]
    for path, new in changed:
        print(f"{path}: not laid out by scripts/format.py" if "--check" in sys.argv else path)
        if "--check" not in sys.argv:
            (ROOT / path).write_text(new, encoding="utf-8")
    return 1 if changed and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
