#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The limits of CONTRIBUTING.md, read from the sources: lines of a file and of a function,
parameters, columns, the licence's line.

    check_form.py ROOT          exits with 1 and a line for each thing over a limit
    check_form.py --self-test   shows that each limit is found to be broken

What was over a limit when this script came is listed in OVER with the size it has; it may shrink,
not grow, and one that has come under its
limit must leave the list. C++ and GLSL are read by brackets, not parsed: a definition is a name,
its arguments and a body."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

FILE_LINES = {".cpp": 400, ".h": 200, ".py": 400} | dict.fromkeys(
    (".glsl", ".vert", ".frag", ".comp"), 250
)
FUNCTION_LINES = 60
PARAMETERS = 5
COLUMNS = 100
DOC_COLUMNS = 120  # of a source in docs/, as of its pages
TEXT_COLUMNS = 200  # of a line of Python with a text in it, which no tool can break
CURLY = tuple(suffix for suffix in FILE_LINES if suffix != ".py")
NO_FUNCTIONS = {
    "if",
    "for",
    "while",
    "switch",
    "return",
    "catch",
    "sizeof",
    "alignof",
    "defined",
    "layout",
}
TAIL = re.compile(
    r"\s*(?:const|noexcept|override|final|mutable|->[\w:<>&*,\s]+|:[^;{]*?(?:\{[^{}]*\}[^;{]*?)*)?\s*(?:const|noexcept|override)?\s*\{"
)

# file, or file:function -> what it has.
OVER = {
    "scripts/make_mesh_samples.py": 630,
    "scripts/make_mesh_samples.py:write": 63,
    "scripts/texgen_pictures.py:rows": 107,
    "shaders/blades/surface_blade.vert:join_far_pose()": 6,
    "shaders/shared/blade_physics.h": 331,
    "shaders/shared/march.h": 449,
    "shaders/shared/shading.h": 230,
    "shaders/shared/track.h": 243,
    "shaders/shared/track.h:track_change()": 6,
    "shaders/shared/track_seen.h": 225,
    "shaders/shared/wind.h:wind_tap_velocity()": 6,
    "shaders/shells/march.frag": 314,
    "shaders/shells/march.frag:main": 69,
    "shaders/shells/march.frag:march": 68,
    "shaders/shells/march.frag:march()": 6,
    "src/app/arrow_panel.cpp:draw_point()": 6,
    "src/app/arrow_panel.cpp:edit_number()": 6,
    "src/app/flow_overlay.cpp:draw_streak()": 6,
    "src/app/options.cpp:declare_render": 68,
    "src/assets/image_file.cpp:check_size()": 7,
    "src/base/error.cpp:input_error()": 6,
    "src/blades/blade_twin.cpp:step_blade()": 6,
    "src/grass/bc5.cpp:compress_block()": 6,
    "src/grass/bc5.cpp:decode_block()": 6,
    "src/grass/set_reader.cpp:read_angles()": 6,
    "src/terrain/terrain_pass.cpp:visible_blocks()": 6,
    "tests/cli/geotiff.py:geotiff": 86,
    "tests/cli/test_feed.py:columns": 103,
    "tests/cli/test_feed.py:net_fdm()": 7,
    "tests/cli/test_feed.py:test_aircraft": 76,
    "tests/cli/test_ground.py:test_poses_on_earth": 63,
    "tests/cli/test_texgen.py": 538,
    "tests/cli/test_texgen_export.py": 594,
    "tests/cli/test_texgen_import.py": 469,
    "tests/cli/test_view.py": 540,
    "tests/cli/test_view.py:test_a_kept_flight_is_the_same_at_any_rate": 85,
    "tests/gl/blades_test.cpp": 413,
    "tests/gl/blades_test.cpp:blade_surface()": 6,
    "tests/gl/fixture.h": 203,
    "tests/gl/layout_test.cpp:Layout.FrameConstants": 63,
    "tests/gl/near_physics_test.cpp": 452,
    "tests/gl/near_physics_test.cpp:NearPhysics.StatesEqualTheTwinOverSixHundredSteps": 65,
    "tests/gl/programs_test.cpp": 521,
    "tests/gl/programs_test.cpp:Programs.BlocksAreBoundByTheirNames": 97,
    "tests/gl/programs_test.cpp:Programs.SamplersReadTheUnitsOfTheirNames": 64,
    "tests/gl/programs_test.cpp:variants": 91,
    "tests/gl/render_test.cpp": 456,
    "tests/gl/state_test.cpp": 431,
    "tests/gl/state_test.cpp:State.AHostsWallStandsInTheGrassWhateverItsDepth": 73,
    "tests/gl/state_test.cpp:set": 62,
    "tests/gl/state_test.cpp:take": 97,
    "tests/gl/surface_test.cpp:SurfaceScenes.LivingBladesOfAMeshEqualTheTwin": 71,
    "tests/gl/tracks_living_test.cpp:TracksLiving.ABladeThatWakesOnATrackBeginsPressedAndStaysSo": 82,
    "tests/gl/wind_sources_test.cpp:arrow()": 6,
    "tests/unit/assets_fixture.h": 241,
    "tests/unit/assets_fixture.h:affine()": 6,
    "tests/unit/assets_fixture.h:bytes": 66,
    "tests/unit/assets_fixture.h:png()": 6,
    "tests/unit/assets_kinds_test.cpp": 415,
    "tests/unit/assets_mesh_test.cpp:columns": 114,
    "tests/unit/assets_test.cpp": 588,
    "tests/unit/base_test.cpp": 525,
    "tests/unit/feed_test.cpp": 407,
    "tests/unit/grass_light_test.cpp": 410,
    "tests/unit/grass_raster_test.cpp:Raster.ATexelNamesABladeThatStandsWhereItSays": 78,
    "tests/unit/near_pose_test.cpp:drawn_tip()": 7,
    "tests/unit/scene_test.cpp": 782,
    "tests/unit/scene_test.cpp:SceneFile.ReadsEveryKey": 102,
    "tests/unit/scene_test.cpp:columns": 111,
    "tests/unit/scene_wind_test.cpp:WindSection.ReadsEveryKindOfSource": 72,
    "tests/unit/shared_handover_test.cpp:tiers_that_draw()": 6,
    "tests/unit/surface_placement_test.cpp": 402,
    "tests/unit/tracks_test.cpp": 419,
    "tests/unit/wind_sources_test.cpp": 509,
    "texgen/bake/preview.cpp:top_view()": 6,
    "texgen/cli/options.cpp": 421,
    "texgen/export/export_textures.cpp:write_variant()": 6,
}


def without_text(source):
    """C++ or GLSL without comments, strings and directives; every line stays in its place."""
    blank = lambda m: '""' + "\n" * m.group(0).count("\n")  # noqa: E731
    source = re.sub(r'R"(\w*)\(.*?\)\1"', blank, source, flags=re.S)
    source = re.sub(r'"(?:\\.|[^"\\\n])*"', '""', source)
    source = re.sub(r"(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'", "0", source)
    source = re.sub(r"/\*.*?\*/", lambda m: "\n" * m.group(0).count("\n"), source, flags=re.S)
    source = re.sub(r"//[^\n]*", "", source)
    return "\n".join("" if line.lstrip().startswith("#") else line for line in source.split("\n"))


def closing(text, at, pair):
    """Index after the bracket that closes the one before `at`."""
    depth = 1
    while at < len(text) and depth:
        depth += (text[at] == pair[0]) - (text[at] == pair[1])
        at += 1
    return at


def count_parameters(arguments):
    depth, count = 0, 1 if arguments.strip() not in ("", "void") else 0
    for letter in arguments:
        depth += (letter in "(<[{") - (letter in ")>]}")
        count += letter == "," and depth == 0
    return count


def functions_of_curly(source):
    """(name, line, lines, parameters) of each definition."""
    text = without_text(source)
    for match in re.finditer(r"([A-Za-z_][\w:~]*)\s*\(", text):
        name = match.group(1)
        before = text[max(0, match.start() - 80) : match.start()]
        if (
            name in NO_FUNCTIONS
            or not re.search(r"[\w>&*\]]\s+[&*]?$|\n\s*(?:explicit )?$", before)
            or re.search(r"(?:return|new|throw|else)\s+$", before)
        ):
            continue
        end = closing(text, match.end(), "()")
        tail = TAIL.match(text, end)
        if not tail:
            continue
        stop = closing(text, tail.end(), "{}")
        parameters = 0 if name.startswith("TEST") else count_parameters(text[match.end() : end - 1])
        if name.startswith("TEST"):
            name = re.sub(r"\W+", ".", text[match.end() : end - 1])
        yield (
            name,
            text.count("\n", 0, match.start()) + 1,
            text.count("\n", match.start(), stop) + 1,
            parameters,
        )


def functions_of_python(source):
    lines = source.split("\n")
    for number, line in enumerate(lines):
        match = re.match(r"(\s*)def (\w+)\(", line)
        if not match:
            continue
        last = number
        for after in range(number + 1, len(lines)):
            if (
                lines[after].strip()
                and len(lines[after]) - len(lines[after].lstrip()) <= len(match.group(1))
                and not lines[after].lstrip().startswith(")")
            ):
                break
            last = after if lines[after].strip() else last
        text = source[sum(len(entry) + 1 for entry in lines[:number]) + match.end() :]
        arguments = [
            a.strip() for a in re.split(r",(?![^(\[{]*[)\]}])", text[: closing(text, 0, "()") - 1])
        ]
        own = [
            a
            for a in arguments
            if a and a not in ("self", "cls", "*", "/") and not a.startswith("*") and "=" not in a
        ]
        yield match.group(2), number + 1, last - number + 1, len(own)


def faults(path, source):
    """(key, what it has, limit, words) of everything over a limit in a file."""
    lines = source.count("\n")
    if lines > FILE_LINES[path.suffix]:
        yield str(path), lines, FILE_LINES[path.suffix], f"{path}: {lines} lines"
    if "SPDX-License-Identifier: Apache-2.0" not in source[:120]:
        yield f"{path}:licence", 1, 0, f"{path}: no licence in its first lines"
    for number, line in enumerate(source.split("\n"), 1):
        most = DOC_COLUMNS if path.parts[0] == "docs" else COLUMNS
        if path.suffix == ".py" and re.search("[\"']", line):
            most = TEXT_COLUMNS
        if len(line) > most:
            yield f"{path}:columns", len(line), most, f"{path}:{number}: {len(line)} columns"
    read = functions_of_curly if path.suffix in CURLY else functions_of_python
    for name, line, length, parameters in read(source):
        if length > FUNCTION_LINES:
            yield (
                f"{path}:{name}",
                length,
                FUNCTION_LINES,
                f"{path}:{line}: {name} has {length} lines",
            )
        if parameters > PARAMETERS:
            yield (
                f"{path}:{name}()",
                parameters,
                PARAMETERS,
                f"{path}:{line}: {name} takes {parameters} parameters",
            )


def check(root, over):
    """Words for everything over a limit that `over` does not list, or lists as smaller; and for
    what it lists and is no more."""
    names = subprocess.run(
        ["git", "-C", str(root), "ls-files"], capture_output=True, text=True, check=False
    ).stdout.split("\n")
    if names == [""]:  # an archive without its history
        names = [
            str(p.relative_to(root))
            for top in ("src", "shaders", "texgen", "tests", "scripts")
            for p in (root / top).rglob("*")
        ]
    said, most = [], {}
    for name in sorted(names):
        path = Path(name)
        if path.suffix not in FILE_LINES or not (root / path).is_file():
            continue
        for key, found, limit, words in faults(path, (root / path).read_text(encoding="utf-8")):
            most[key] = max(found, most.get(key, 0))
            if found > over.get(key, 0):
                said.append(f"{words}, expected {over.get(key, limit)} at most")
    said += [f"{key}: within its limit: take it out of OVER" for key in over if key not in most]
    return said, most


def self_test():
    head = "// SPDX-License-Identifier: Apache-2.0\n"
    sources = {
        "long.cpp": head + "int a;\n" * 401,
        "body.cpp": head + "int f(int a) {\n" + "    a += 1;\n" * 60 + "}\n",
        "many.cpp": head
        + "int g(int a, int b, std::map<int, int> c, int d, int e, int f) { return 0; }\n",
        "bare.h": "#pragma once\n",
        "wide.h": head + "// " + "x" * COLUMNS + "\n",
        "body.py": "# SPDX-License-Identifier: Apache-2.0\ndef f(a):\n" + "    a += 1\n" * 60,
        "good.cpp": head + "int h(int a) { return f(a, {1, 2}); }\n",
        "text.cpp": head
        + 'const char* kText = "int f(int a, int b, int c, int d, int e, int f) {";\n',
    }
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "src").mkdir()
        for name, text in sources.items():
            (root / "src" / name).write_text(text)
        said, most = check(root, {})
        assert {key.split("/")[1].split(":")[0] for key in most} == {
            "long.cpp",
            "body.cpp",
            "many.cpp",
            "bare.h",
            "wide.h",
            "body.py",
        }, most
        assert len(said) == 6, said
        assert check(root, most)[0] == []
        assert any("take it out" in word for word in check(root, most | {"src/gone.cpp": 500})[0])
        assert any("body.cpp" in word for word in check(root, {**most, "src/body.cpp:f": 61})[0])
    print("six kinds of fault found, and none where there is none")


def main():
    if sys.argv[1] == "--self-test":
        self_test()
        return 0
    said, most = check(Path(sys.argv[1]), OVER)
    if sys.argv[2:] == ["--list"]:
        print("".join(f'    "{key}": {value},\n' for key, value in sorted(most.items())), end="")
        return 0
    print("\n".join(said) or f"within the limits, but for {len(OVER)} that are listed")
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main())
