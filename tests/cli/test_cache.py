# SPDX-License-Identifier: Apache-2.0
"""Presets in scenes: baked on first use, found again, rebuilt when the cache cannot be trusted."""

import os
import threading

import sward_cli
from sward_cli import CliCase, environment


class Cache(CliCase):
    def setUp(self):
        super().setUp()
        self.scene(sward_cli.SCENE.replace('"set"', '"grass.toml"'))
        (self.dir / "grass.toml").write_text(sward_cli.TINY_PRESET)
        self.cache = self.dir / "cache"
        self.env = environment(XDG_CACHE_HOME=self.cache)

    def picture(self, name="out.png"):
        result = self.render("-o", name, env=self.env)
        self.assert_done(result)
        return (self.dir / name).read_bytes(), result.err

    def baked(self):
        return [path for path in (self.cache / "sward/sets").iterdir() if path.is_dir()]

    def test_first_use(self):
        first, said = self.picture()
        self.assertIn("grass.toml", said)
        self.assertEqual(len(self.baked()), 1)
        stamp = (self.baked()[0] / "set.json").stat().st_mtime_ns
        second, said = self.picture()
        self.assertEqual(said, "")
        self.assertTrue(first == second)
        self.assertEqual((self.baked()[0] / "set.json").stat().st_mtime_ns, stamp)
        (self.dir / "grass.toml").write_text(sward_cli.TINY_PRESET.replace("seed = 3", "seed = 4"))
        third, _ = self.picture()
        self.assertEqual(len(self.baked()), 2)
        self.assertTrue(first != third)

    def test_damaged(self):
        first, _ = self.picture()
        content = {path.name: path.read_bytes() for path in self.baked()[0].iterdir()}
        damages = [
            lambda s: (s / "set.json").write_text("{}"),
            lambda s: (s / "layers.ktx2").unlink(),
            lambda s: (s / "slices.ktx2").write_bytes(b"x"),
            lambda s: (s / "more").mkdir(),
        ]
        for damage in damages[:3]:
            damage(self.baked()[0])
            again, said = self.picture()
            self.assertEqual(said.count("warning: "), 1, said)
            self.assertNotIn("error: ", said)
            self.assertTrue(first == again)
            self.assertEqual({p.name: p.read_bytes() for p in self.baked()[0].iterdir()}, content)

    def test_of_another_texgen(self):
        """What counts is which texgen baked a set, not when: a clock may be wrong."""
        self.picture()
        made = self.baked()[0] / "set.json"
        os.utime(made, (1, 1))
        _, said = self.picture()
        self.assertEqual((said, made.stat().st_mtime), ("", 1))
        note = made.parent.with_suffix(".texgen")
        note.write_text("0" * 64)
        _, said = self.picture()
        self.assertIn("baked on first use", said)
        self.assertGreater(made.stat().st_mtime, 1)
        self.assertEqual(self.picture()[1], "")

    def test_two_at_once(self):
        """The second waits for the first, and both draw the same."""
        results = []

        def draw(name):
            results.append(self.render("-o", name, env=self.env))

        threads = [threading.Thread(target=draw, args=(f"{i}.png",)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([result.code for result in results], [0, 0], [r.err for r in results])
        self.assertEqual(sum("baked on first use" in result.err for result in results), 1)
        self.assertTrue((self.dir / "0.png").read_bytes() == (self.dir / "1.png").read_bytes())
        self.assertEqual(len(self.baked()), 1)

    def test_bad_preset(self):
        """texgen tells what is wrong, once; sward ends with its code."""
        (self.dir / "grass.toml").write_text("seed = 'three'\n")
        result = self.render("-q", env=self.env)
        self.assertEqual(result.code, 3, result.err)
        self.assert_refusal(result, 3, "grass.toml", "seed")
        self.assertFalse((self.dir / "out.png").exists())
        self.assertEqual(self.baked(), [])

    def test_no_place(self):
        env = environment(XDG_CACHE_HOME=None, HOME=None)
        self.refuse(5, ["XDG_CACHE_HOME"], "render", "scene.toml", "-o", "out.png", env=env)
        closed = self.dir / "closed"
        closed.mkdir(mode=0o555)
        env = environment(XDG_CACHE_HOME=closed)
        self.refuse(
            5,
            ["closed", "XDG_CACHE_HOME"],
            "render",
            "scene.toml",
            "-o",
            "out.png",
            env=env,
            prefix=sward_cli.without_root(),
        )

    def test_shipped_preset(self):
        """A preset that lies nowhere beside the scene is one of those that ship."""
        scene = self.dir / "scene.toml"
        scene.write_text(sward_cli.SCENE.replace('"set"', '"no-such-preset.toml"'))
        self.refuse(5, ["no-such-preset.toml", "presets"], "render", "scene.toml", "-o", "out.png")


if __name__ == "__main__":
    sward_cli.main()
