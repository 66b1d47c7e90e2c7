# SPDX-License-Identifier: Apache-2.0
"""Scenes on a mesh and objects as a user meets them: what is refused, what is kept, what may be
left out."""

import sward_cli
from small_files import glb
from sward_cli import CliCase, SIZE, environment

SCENE = """\
[terrain]
surface = "m.glb"
[surface_grass]
density_per_m2 = 200
[camera.near]
position = [0, 1.2, 2.5]
pitch_deg = -20
"""
OBJECT = """\
[[object]]
kind = "mesh"
mesh = "box.glb"
position = [0, 0, 0]
most_spheres = 20
"""


SHEET = ([(-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1)], [(0, 1, 2), (0, 2, 3)])
BOX = (
    [(x, y, z) for z in (-0.3, 0.3) for y in (-0.3, 0.3) for x in (-0.3, 0.3)],
    [
        t
        for a, b, c, d in (
            (0, 4, 6, 2),
            (1, 3, 7, 5),
            (0, 1, 5, 4),
            (2, 6, 7, 3),
            (0, 2, 3, 1),
            (4, 5, 7, 6),
        )
        for t in ((a, b, c), (a, c, d))
    ],
)


class Surface(CliCase):
    def setUp(self):
        super().setUp()
        sward_cli.WORK.mkdir(parents=True, exist_ok=True)
        self.scene(SCENE)
        (self.dir / "m.glb").write_bytes(glb(*SHEET))
        (self.dir / "box.glb").write_bytes(glb(*BOX))
        self.cache = self.dir / "cache"
        # The driver's own cache is shared: compiling shaders anew costs more than all else here.
        self.env = environment(XDG_CACHE_HOME=self.cache)

    def scene(self, text=SCENE, name="scene.toml"):
        (self.dir / name).write_text(text)

    def refuse_scene(self, code, pieces, text=SCENE):
        self.scene(text)
        self.refuse(code, pieces, "render", "scene.toml", "-o", "out.png", "--size", SIZE)

    def test_no_set_is_baked(self):
        self.assert_done(self.render("-o", "out.png", "--camera", "near", env=self.env))
        self.assertFalse((self.cache / "sward/sets").exists())

    def test_meshes_that_are_refused(self):
        nan = float("nan")
        flat = [(0, 0, 0), (1, 0, 0), (2, 0, 0)]
        for positions, triangles, pieces in (
            (flat, [(0, 1, 2)], ["m.glb", "triangle with an area"]),
            ([(0, 0, 0), (1, 0, 0), (nan, 0, 1)], [(0, 1, 2)], ["m.glb", "finite"]),
            (SHEET[0], [(0, 1, 9)], ["m.glb", "9"]),
            (SHEET[0], [], ["m.glb"]),
        ):
            (self.dir / "m.glb").write_bytes(glb(positions, triangles))
            self.refuse_scene(3, pieces)

    def test_too_many_blades(self):
        (self.dir / "m.glb").write_bytes(
            glb([(20 * x, y, 20 * z) for x, y, z in SHEET[0]], SHEET[1])
        )
        self.refuse_scene(
            4,
            ["m.glb", "1440000000 blades", "at most 10000000"],
            SCENE.replace("= 200", "= 900000"),
        )

    def test_too_steep(self):
        (self.dir / "m.glb").write_bytes(glb([(x, z, 0) for x, _, z in SHEET[0]], SHEET[1]))
        self.refuse_scene(
            3,
            ["m.glb", "no area that leans at most 10 degrees"],
            SCENE.replace("= 200", "= 200\nslope_deg = 10"),
        )

    def test_spheres_are_packed_once(self):
        self.scene(SCENE + OBJECT)
        first = self.render("-o", "a.png", "--camera", "near", env=self.env)
        self.assert_done(first)
        self.assertRegex(first.err, "packed with [0-9]+ spheres")
        kept = list((self.cache / "sward/spheres").iterdir())
        self.assertEqual(len(kept), 1)
        content = kept[0].read_bytes()
        second = self.render("-o", "b.png", "--camera", "near", env=self.env)
        self.assertEqual(second.err, "")
        for damage in (b"", content[:80] + b"x" + content[81:]):
            kept[0].write_bytes(damage)
            again = self.render("-o", "b.png", "--camera", "near", env=self.env)
            self.assert_done(again)
            self.assertEqual(again.err.count("warning: "), 1, again.err)
            self.assertEqual(kept[0].read_bytes(), content)

    def test_a_cache_that_cannot_be_written_is_no_failure(self):
        self.scene(SCENE + OBJECT)
        self.cache.write_text("in the way")
        result = self.render("-o", "a.png", "--camera", "near", env=self.env)
        self.assert_done(result)
        self.assertIn("warning: the spheres of a mesh are not kept", result.err)

    def test_an_open_object_is_for_show_alone(self):
        (self.dir / "box.glb").write_bytes(glb(*SHEET))
        self.refuse_scene(3, ["box.glb", "a rim", "object.collides = false"], SCENE + OBJECT)
        self.scene(SCENE + OBJECT + "collides = false\n")
        self.assert_done(self.render("-o", "a.png", "--camera", "near", env=self.env))

    def test_wind_knows_no_elevation(self):
        self.assert_done(
            self.sward("wind", "scene.toml", "--time", "0.1", "-o", "w.exr", env=self.env)
        )


if __name__ == "__main__":
    sward_cli.main()
