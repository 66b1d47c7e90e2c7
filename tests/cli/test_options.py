# SPDX-License-Identifier: Apache-2.0
"""The command line: what is refused, with which words, and what works without a GPU."""

import shutil

import sward_cli
from sward_cli import CliCase, environment

NO_GPU = {"__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent"}
BAD_NUMBERS = ["64px", "", "nan", "inf", "1e400", "1,5", "0x10", " 1", "+1"]


class Options(CliCase):
    def refuse_render(self, code, pieces, *arguments, **options):
        self.refuse(code, pieces, "render", "scene.toml", "-o", "out.png", *arguments, **options)

    def test_numbers(self):
        self.scene()
        for option in ("--time", "--frame-index"):
            for text in BAD_NUMBERS:
                with self.subTest(option=option, text=text):
                    self.refuse_render(2, [option, text, "expected"], option, text)
        for option in ("--exposure", "--reference-grid", "--density"):
            with self.subTest(option=option):
                self.refuse_render(2, [option, "nan"], f"{option}=nan")
        for option in ("--time", "--exposure", "--density", "--blades-distance", "--warm"):
            with self.subTest(option=option):
                self.refuse_render(2, [option, '"-1"'], option, "-1")
        for option in ("--frame-index", "--warm", "--force-tier", "--samples"):
            with self.subTest(option=option):
                self.refuse_render(
                    2, [option, "9223372036854775808"], option, "9223372036854775808"
                )

    def test_size(self):
        self.scene()
        for text in (
            "64px",
            "-1",
            "0x10",
            "10x0",
            "64",
            "64x",
            "x64",
            "64x36x1",
            "1.5x2",
            "",
            "nanxnan",
        ):
            with self.subTest(text=text):
                self.refuse_render(2, ["--size", "expected"], "--size", text)
        for text in ("16385x1", "1x16385", "1000000x1000000", "9223372036854775808x1"):
            with self.subTest(text=text):
                self.refuse_render(4, ["--size", text], "--size", text)

    def test_choices_and_poses(self):
        self.scene()
        cases = [
            ("--tiers", "most"),
            ("--handover", "soft"),
            ("--cull", "frustum,depth"),
            ("--cull", "occlusion,occlusion"),
            ("--samples", "3"),
            ("--far", "shells"),
            ("--camera", "raod"),
            ("--camera", "1,2,3"),
            ("--camera", ""),
            ("--path", "rol"),
            ("--lod-eye", "1,2"),
            ("--frames", "5:1"),
            ("--frames", "1"),
            ("--frames", "-1:2"),
            ("--fixed-timestep", "0"),
        ]
        for option, text in cases:
            with self.subTest(option=option, text=text):
                self.refuse_render(2, [option, "found", text, "expected"], option, text)
        self.refuse_render(2, ["--camera", "road"], "--camera", "raod")  # the known names are told
        self.refuse_render(2, ["--camera", "nan"], "--camera", "1,2,3,4,nan")

    def test_camera_matrices(self):
        """Refused before a set is baked for it, by the file's name."""
        self.scene()

        def wants(text, *pieces):
            (self.dir / "camera.json").write_text(text)
            self.refuse_render(3, ["camera.json", *pieces], "--camera-matrices", "camera.json")

        one = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        flat = [0] * 14 + [-1, 0]
        wants("{", "no JSON")
        wants('{"clip_from_view": []}', "view_from_world", "nothing")
        wants(
            f'{{"view_from_world": {one}, "clip_from_view": "x"}}', "clip_from_view", "16 numbers"
        )
        wants(
            f'{{"view_from_world": {one}, "clip_from_view": {flat}}}',
            "clip_from_view",
            "without width",
        )
        wants(
            f'{{"view_from_world": {[2] + one[1:]}, "clip_from_view": {flat}}}', "view_from_world"
        )
        self.refuse_render(5, ["nowhere.json"], "--camera-matrices", "nowhere.json")

    def test_usage(self):
        self.scene()
        self.refuse(2, ["subcommand"])
        self.refuse(2, ["bogus"], "bogus")
        self.refuse(2, ["SCENE"], "render")
        self.refuse(2, ["--output"], "render", "scene.toml")
        self.refuse(2, ["--output"], "render", "scene.toml", "-o")
        self.refuse(2, ["SCENE"], "render", "", "-o", "out.png")
        self.refuse_render(2, ["--bogus"], "--bogus")
        self.refuse_render(2, ["scene2.toml"], "scene2.toml")
        self.refuse_render(2, ["--time", "2 times"], "--time", "1", "--time", "1")
        self.refuse_render(2, ["--camera", "--path"], "--camera", "road", "--path", "roll")
        self.refuse_render(2, ["\\n"], "two\nlines")
        for word in ("--debug-gl=3", "--count-steps=no", "-q=1", "--version=1", "--help="):
            name, value = word.split("=")
            self.refuse_render(2, [f'error: {name}: found "{value}", expected no value'], word)
        self.refuse(2, ["--list-joysticks: found"], "view", "--list-joysticks=5")

    def test_a_wrong_option_is_blamed(self):
        self.scene()
        for words in (
            ["render", "scene.toml", "-n", "8", "-o", "out.png"],
            ["-n", "8", "render", "scene.toml", "-o", "out.png"],
            ["render", "-n", "8", "scene.toml"],
            ["view", "-n", "8"],
            ["wind", "scene.toml", "-n", "8"],
            ["bench", "-n", "8"],
            ["info", "-n", "8"],
        ):
            with self.subTest(words=words):
                self.refuse(2, ["error: -n: found an unknown option", "--help"], *words)
        self.refuse_render(
            2, ["error: --sise: found an unknown option", "perhaps --size"], "--sise", "64x36"
        )
        self.refuse(
            2, ['error: --output: found "--size"'], "render", "scene.toml", "-o", "--size", "64x36"
        )

    def test_a_flag_has_no_value(self):
        """`--flag=3` and `--flag=false` are nonsense, told as such before anything is read."""
        for words in (
            ["view", "no.toml", "--no-wake=3"],
            ["view", "no.toml", "--list-joysticks=false"],
            ["render", "no.toml", "-o", "no.png", "--count-steps="],
            ["bench", "far", "--full=1"],
            ["info", "-q=3"],
            ["--version=3"],
        ):
            with self.subTest(words):
                flag, value = words[-1].split("=")
                self.refuse(2, [f'error: {flag}: found "{value}"', "no value"], *words)
        for words in (["--dry-run=3"], ["verify", "--json=0"]):
            result = sward_cli.run("texgen", *words)
            self.assertEqual(result.code, 2)
            self.assertIn("expected no value", result.err)

    def test_aovs(self):
        self.scene()
        self.refuse_render(2, ["--output", "exr"], "--aov", "depth")
        for text in ("deep", "depth,,tier", "depth,depth", ""):
            with self.subTest(text=text):
                self.refuse(2, ["--aov"], "render", "scene.toml", "-o", "out.exr", "--aov", text)

    def test_help_and_info_without_gpu(self):
        env = environment(**NO_GPU)
        for program, arguments in (
            ("sward", ["--help"]),
            ("sward", ["--version"]),
            ("sward", ["render", "--help"]),
            ("sward", ["view", "--help"]),
            ("texgen", ["--help"]),
            ("texgen", ["--version"]),
        ):
            with self.subTest(program=program, arguments=arguments):
                result = sward_cli.run(program, *arguments, env=env)
                self.assert_done(result)
                self.assertTrue(result.out)
                self.assertEqual(result.err, "")
        result = self.sward("info", env=env)
        self.assert_done(result)
        self.assertIn("none that can render", result.out)
        result = self.sward("info")
        self.assert_done(result)
        self.assertRegex(result.out, r"opengl +4\.")

    def test_locale(self):
        """A comma as decimal point in the environment changes neither what is read nor what is
        refused."""
        self.scene()
        env = environment(LC_ALL="de_DE.UTF-8", LC_NUMERIC="de_DE.UTF-8")
        self.refuse_render(2, ["--time", "1,5"], "--time", "1,5", env=env)
        self.assert_done(self.render("--time", "1.5", env=env))
        first = (self.dir / "out.png").read_bytes()
        self.assert_done(self.render("--time", "1.5"))
        self.assertEqual(first, (self.dir / "out.png").read_bytes())

    def test_texgen_flags_and_sizes(self):
        (self.dir / "tiny.toml").write_text(sward_cli.TINY_PRESET)
        bake = ("tiny.toml", "-o", "set")
        for command, word in (
            *((bake, word) for word in ("--dry-run=no", "--no-wrap=", "-q=3", "--version=1")),
            (("import", "a.vdb", "-o", "set"), "--no-preview=no"),
            (("verify", "set"), "--json=1"),
        ):
            name, value = word.split("=")
            said = f'error: {name}: found "{value}", expected no value'
            self.refuse(2, [said], *command, word, program="texgen")
        for value, said in (
            ("", "--size: found nothing, expected N"),
            ("33", "--size 33: texture.size"),
        ):
            self.refuse(2, [said], *bake, f"--size={value}", program="texgen")

    def test_texgen_numbers(self):
        (self.dir / "tiny.toml").write_text(sward_cli.TINY_PRESET)
        for option in ("--size", "--variants", "--seed", "--layers"):
            for text in ("64px", "-1", "nan", "", "1e400", "9223372036854775808"):
                with self.subTest(option=option, text=text):
                    if option == "--seed" and text == "9223372036854775808":
                        continue  # a seed may be any 64 bits
                    shutil.rmtree(self.dir / "set", ignore_errors=True)
                    result = sward_cli.run(
                        "texgen", "tiny.toml", "-o", "set", option, text, cwd=self.dir
                    )
                    self.assertIn(result.code, (2, 4), result.err)
                    self.assertEqual(len(result.err.splitlines()), 1, result.err)
                    self.assertIn(option, result.err)
                    self.assertFalse((self.dir / "set").exists())


if __name__ == "__main__":
    sward_cli.main()
