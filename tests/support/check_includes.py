# SPDX-License-Identifier: Apache-2.0
"""Fails when an #include or a target_link_libraries runs against the arrows of the house.

    check_includes.py ROOT       checks src/, texgen/ and shaders/ under ROOT
    check_includes.py --self-test    shows that a forbidden include and a forbidden link are caught

The table below is docs/architecture.md in a form a machine reads: each module lists those it stands
on directly, and may
include them and all below them. Modules that do not reach one another do not know each other.
"""

import re
import sys
import tempfile
from pathlib import Path

ARROWS = {
    "app": {"render", "assets", "feed", "input", "drive", "fly"},
    "drive": {"scene"},
    "fly": {"scene"},
    "render": {"blades", "shells", "tracks"},
    "blades": {"lod", "wind"},
    "shells": {"lod", "wind"},
    "lod": {"terrain"},
    "wind": {"terrain"},
    "tracks": {"terrain"},
    "terrain": {"grass", "scene", "gl"},
    "grass": {"base"},
    "scene": {"base"},
    "gl": {"base"},
    "feed": {"scene"},
    "input": {"scene"},
    "assets": {"scene"},
    "texgen/cli": {"texgen/report", "texgen/import", "texgen/export"},
    "texgen/report": {"texgen/bake"},
    "texgen/import": {"texgen/bake", "texgen/seam"},
    "texgen/export": {"texgen/bake", "texgen/seam"},
    "texgen/seam": {"texgen/vdb"},
    "texgen/bake": {"texgen/far", "texgen/vdb"},
    "texgen/far": {"texgen/patch"},
    "texgen/vdb": {"texgen/patch"},
    "texgen/patch": {"texgen/preset"},
    "texgen/preset": {"texgen/support"},
    "texgen/support": {"grass", "assets"},
    "base": set(),
}
# Code that GLSL compiles: `shared` is everyone's, `lib` is the shaders' own; both stand on nothing
# of src/.
SHARED = "shared"
LIB = "lib"
# The public headers: everyone may include them, and they stand on the standard library and on GLM's
# vectors and matrices alone.
FACE = "sward"
FACE_INCLUDE = re.compile(r"^(sward/[a-z_]+\.h|glm/(vec|mat)[234](x[234])?\.hpp|[a-z_]+)$")

# The one house of each heavy library: an include of it anywhere else drags it into what a simulator
# links.
HOUSES = {
    "openvdb/": {"assets", "texgen/vdb"},
    "OpenImageIO/": {"assets"},
    "gdal": {"assets"},
    "ogr_": {"assets"},
    "sqlite3": {"assets"},
    "GLFW/": {"app"},
    "imgui": {"app"},
    "Bullet": {"drive"},
    "btBullet": {"drive"},
    "backends/imgui": {"app"},
    "CLI/": {"app", "texgen/cli"},
    "stb/": {"texgen/bake"},
    "tiny_gltf": {"assets", "grass"},
    "epoxy/": {"gl", "terrain", "blades", "shells", "wind", "tracks", "lod", "render", "app"},
    "toml++/": {"scene", "texgen/preset", "drive"},
}
SUFFIXES = {".h", ".cpp", ".glsl", ".vert", ".frag", ".comp", ".tesc", ".tese", ".geom"}
INCLUDE = re.compile(r'^\s*#\s*include\s+(["<])([^">]+)[">]')


def below(module):
    """Every module that `module` may include."""
    seen, todo = set(), list(ARROWS[module])
    while todo:
        name = todo.pop()
        if name not in seen:
            seen.add(name)
            todo += ARROWS[name]
    return seen


def module_of(path, root):
    """The module that a file of the tree belongs to; None outside the house."""
    parts = path.relative_to(root).parts
    if parts[0] == "texgen":
        return "/".join(parts[:2]) if len(parts) > 2 else None
    if parts[0] in ("src", "shaders") and len(parts) > 2:
        return parts[1]
    return None


def included_file(path, name, root):
    """The file of the tree that an include in `path` finds; None for one from outside."""
    folders = [path.parent, root / "src", root / "shaders", root]
    for folder in folders:
        candidate = (folder / name).resolve()
        if candidate.is_file() and candidate.is_relative_to(root):
            return candidate
    return None


def may_include(module, target, is_shader):
    if target in (module, SHARED, FACE):
        return True
    if module in (SHARED, LIB):  # shared stands on itself, lib on shared: both returned above
        return False
    if target == LIB:
        return is_shader
    return module in ARROWS and target in below(module)


def check_house_of(path, line, name, module):
    for prefix, houses in HOUSES.items():
        if name.startswith(prefix) and module not in houses:
            return [
                f"{line}: {module} includes <{name}>, which only {', '.join(sorted(houses))} may"
            ]
    return []


def check_file(path, root, uses):
    """Messages about one file; adds to `uses` the pairs of modules that its includes join."""
    module = module_of(path, root)
    if module is None:
        return [f"{path.relative_to(root)}: stands in no module"]
    if module not in ARROWS and module not in (SHARED, LIB, FACE):
        return [f"{path.relative_to(root)}: module {module} is missing in the table of arrows"]
    is_shader = path.is_relative_to(root / "shaders")
    messages = []
    for number, text in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(text)
        if not match:
            continue
        where, name = f"{path.relative_to(root)}:{number}", match.group(2)
        messages += check_house_of(path, where, name, module)
        if module == FACE and not FACE_INCLUDE.match(name):
            messages.append(f"{where}: a public header may not include {name}")
        found = included_file(path, name, root)
        if found is None and (root / "src" / (name + ".in")).is_file():
            continue  # made when the project is configured
        if found is None:
            if match.group(1) == '"' and not any(name.startswith(p) for p in HOUSES):
                messages.append(f'{where}: "{name}" is no file of the tree')
            continue
        target = module_of(found, root)
        if target is None or not may_include(module, target, is_shader):
            messages.append(f"{where}: {module} may not include {name} ({target or 'no module'})")
        elif target != module and not is_shader and target not in (SHARED, FACE):
            uses.add((module, target))
    return messages


def linked_modules(root):
    """What each CMakeLists.txt links: {module: set of modules}."""
    links = {}
    for path in [*sorted((root / "src").glob("*/CMakeLists.txt")), root / "texgen/CMakeLists.txt"]:
        if not path.is_file():
            continue
        module = path.parent.name
        code = "\n".join(line.split("#")[0] for line in path.read_text().splitlines())
        names = set(re.findall(r"\bsward_([a-z]+)\b", code))
        links[module] = {name for name in names if name in ARROWS and name != module}
    for room in ARROWS:  # texgen's rooms are linked as one
        if room.startswith("texgen/") and "texgen" in links:
            links[room] = links["texgen"]
    links.pop("texgen", None)
    return links


def reach(links, module):
    seen, todo = set(), list(links.get(module, ()))
    while todo:
        name = todo.pop()
        if name not in seen:
            seen.add(name)
            todo += links.get(name, ())
    return seen


def check_links(root, uses):
    links = linked_modules(root)
    messages = []
    for module, targets in links.items():
        if module not in ARROWS:
            messages.append(f"{module}/CMakeLists.txt: module is missing in the table of arrows")
            continue
        for target in sorted(targets - below(module)):
            messages.append(f"{module}/CMakeLists.txt: {module} may not link {target}")
    for module, target in sorted(uses):
        if not target.startswith("texgen/") and target not in reach(links, module):
            messages.append(
                f"{module}/CMakeLists.txt: {module} includes {target} but does not link it"
            )
    return messages


def check_tree(root):
    """(messages, files read). `root` is absolute and resolved."""
    files = [
        p
        for folder in ("src", "texgen", "shaders")
        for p in sorted((root / folder).rglob("*"))
        if p.is_file() and p.suffix in SUFFIXES
    ]
    uses, messages = set(), []
    for path in files:
        messages += check_file(path, root, uses)
    return messages + check_links(root, uses), len(files)


def write(root, files):
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


GOOD_TREE = {
    "src/base/error.h": "",
    "src/base/CMakeLists.txt": "sward_module(base)",
    "src/gl/buffer.h": '#include "base/error.h"\n#include "shared/frame.h"\n#include <vector>\n',
    "src/gl/CMakeLists.txt": "sward_module(gl LINKS sward_base)",
    "src/scene/scene.h": '#include "base/error.h"\n',
    "src/scene/CMakeLists.txt": "sward_module(scene LINKS sward_base)",
    "src/sward/view.h": '#include "sward/field.h"\n#include <glm/vec3.hpp>\n#include <vector>\n',
    "src/sward/field.h": "",
    "texgen/support/parallel.h": "",
    "texgen/preset/preset.h": '#include "texgen/support/parallel.h"\n',
    "shaders/shared/frame.h": "",
    "shaders/lib/wind.glsl": '#include "shared/frame.h"\n',
    "shaders/blades/draw.vert": '#include "lib/wind.glsl"\n',
}
# One fault each, and a piece of the message that must name it.
BAD_TREES = [
    ({"src/base/error.h": '#include "gl/buffer.h"\n'}, "base may not include gl/buffer.h"),
    ({"src/gl/buffer.h": '#include "../scene/scene.h"\n'}, "gl may not include ../scene/scene.h"),
    ({"shaders/shared/frame.h": '  #  include "lib/wind.glsl"\n'}, "shared may not include"),
    ({"src/gl/buffer.h": '#include "lib/wind.glsl"\n'}, "gl may not include lib/wind.glsl"),
    ({"src/gl/buffer.h": "#include <openvdb/openvdb.h>\n"}, "gl includes <openvdb/openvdb.h>"),
    ({"src/gl/buffer.h": '#include "gone.h"\n'}, "no file of the tree"),
    (
        {"src/gl/CMakeLists.txt": "sward_module(gl LINKS sward_base sward_scene)"},
        "gl may not link scene",
    ),
    ({"src/gl/CMakeLists.txt": "sward_module(gl)"}, "gl includes base but does not link it"),
    (
        {"src/sward/view.h": '#include "gl/buffer.h"\n'},
        "a public header may not include gl/buffer.h",
    ),
    (
        {"src/sward/view.h": "#include <glm/gtc/packing.hpp>\n"},
        "a public header may not include glm/gtc",
    ),
    (
        {"texgen/support/parallel.h": '#include "texgen/preset/preset.h"\n'},
        "texgen/support may not include texgen/preset",
    ),
    ({"texgen/lost.h": ""}, "stands in no module"),
    ({"src/new/new.h": ""}, "module new is missing"),
]


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder).resolve()
        write(root, GOOD_TREE)
        messages, count = check_tree(root)
        assert not messages and count == 10, (messages, count)
    for fault, expected in BAD_TREES:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            write(root, GOOD_TREE | fault)
            messages, _ = check_tree(root)
            assert any(expected in message for message in messages), (fault, expected, messages)
    print(f"{len(BAD_TREES)} faults caught")
    return 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = Path(sys.argv[1]).resolve()
    messages, count = check_tree(root)
    for message in messages:
        print(f"error: {message}", file=sys.stderr)
    print(f"{count} files, {len(messages)} against the arrows")
    return 1 if messages or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
