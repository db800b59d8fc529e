"""The command line: help, misuse, read-outs, streams. No run takes place here."""

import json
import shutil
import subprocess
import unittest

from program import DATA, PROGRAM, ProgramTest, lamella

COMMANDS = ["run", "resume", "check", "scenes", "explain", "measure", "plot", "view", "export", "import", "version"]


class Help(ProgramTest):
    def test_lists_every_command(self):
        result = lamella("--help")
        self.assert_exit(result, 0)
        for command in COMMANDS + ["render"]:
            self.assertRegex(result.stdout, rf"(?m)^  {command} ")
        self.assertEqual(result.stderr, "")

    def test_shows_examples_for_every_command(self):
        for command in COMMANDS:
            result = lamella(command, "--help")
            self.assert_exit(result, 0)
            self.assertIn("Examples:", result.stdout)
            self.assertIn(f"lamella {command}", result.stdout)


class Misuse(ProgramTest):
    def test_names_the_command_that_was_meant(self):
        self.assert_refused(lamella("rnu", self.scene), "rnu", "did you mean run?")
        self.assert_refused(lamella("polt"), "did you mean plot?")

    def test_names_the_option_that_was_meant(self):
        self.assert_refused(lamella("run", self.scene, "--treads", "2"), "--treads", "did you mean --threads?")

    def test_is_refused_in_one_line(self):
        for arguments in ([], ["run"], ["run", self.scene, "--until", "soon"], ["run", self.scene, "--threads", "-1"],
                          ["run", self.scene, "--progress", "loud"], ["resume"], ["import", "x.json"],
                          ["run", self.scene, "--device", "gpu"], ["version", "now"], ["--bogus"]):
            self.assert_refused(lamella(*arguments, cwd=self.folder))

    def test_of_a_device_that_is_not_there_says_so(self):
        result = lamella("run", self.scene, "--device", "cuda", "--out", self.folder / "run")
        if result.returncode == 0:
            self.skipTest("there is a GPU")
        self.assert_refused(result, "CUDA")
        self.assertFalse((self.folder / "run").exists())


class WrongScenes(ProgramTest):
    def test_are_refused_in_one_line_and_leave_nothing_behind(self):
        scenes = sorted((DATA / "malformed").glob("*.toml"))
        self.assertGreaterEqual(len(scenes), 20)
        for scene in [*scenes, self.folder, self.folder / "missing.toml"]:
            with self.subTest(scene=scene.name):
                for command in ("run", "check"):
                    arguments = ["--out", self.folder / "out"] if command == "run" else []
                    self.assert_refused(lamella(command, scene, *arguments, cwd=self.folder))
                self.assertEqual([path.name for path in self.folder.iterdir()], ["foam.toml"])

    def test_are_named_with_file_and_line(self):
        self.scene.write_text('solver = "bubble"\n[bubble]\ngas_fracton = 0.9\n')
        self.assert_refused(lamella("check", self.scene), f"{self.scene}:3", "gas_fraction")

    def test_from_the_command_line_too(self):
        self.assert_refused(lamella("run", self.scene, "--set", "bubble.gas_fraction=90", "--out", self.folder / "out"),
                            "gas_fraction", "90")
        self.assert_refused(lamella("run", self.scene, "--until", "-1", "--out", self.folder / "out"))
        self.assertFalse((self.folder / "out").exists())

    def test_that_are_not_there_are_told_from_shipped_ones(self):
        self.assert_refused(lamella("run", "bubble/coarsning-2d", cwd=self.folder), "bubble/coarsening-2d")


class ReadOuts(ProgramTest):
    def test_check_prints_a_scene_that_means_the_same(self):
        first = lamella("check", self.scene, "--set", "bubble.gas_fraction=0.9")
        self.assert_exit(first, 0)
        self.assertIn("gas_fraction = 0.9", first.stdout)
        again = self.folder / "again.toml"
        again.write_text(first.stdout)
        self.assertEqual(lamella("check", again).stdout, first.stdout)

    def test_check_knows_json(self):
        report = json.loads(lamella("check", self.scene, "--json").stdout)
        self.assertEqual(report["solver"], "bubble")
        self.assertEqual(report["seed"], 5)
        self.assertTrue(report["characteristic_numbers"])

    def test_scenes_lists_and_prints(self):
        listed = lamella("scenes")
        self.assert_exit(listed, 0)
        self.assertIn("bubble/coarsening-2d-small", listed.stdout)
        printed = lamella("scenes", "bubble/coarsening-2d-small")
        self.assertIn('solver', printed.stdout)
        self.assertIn("bubble/coarsening-2d", [scene["name"] for scene in json.loads(lamella("scenes", "--json").stdout)])

    def test_explain_knows_solvers_groups_and_options(self):
        self.assertIn("bubble", lamella("explain").stdout)
        whole = lamella("explain", "bubble").stdout
        for text in ("bubble.gas.medium_ratio", "bubble.count", "default", "Lankinen20"):
            self.assertIn(text, whole)
        group = lamella("explain", "bubble.gas").stdout
        self.assertIn("medium_ratio", group)
        self.assertNotIn("bubble.count", group)
        [option] = json.loads(lamella("explain", "bubble.gas.medium_ratio", "--json").stdout)
        self.assertEqual(option["name"], "bubble.gas.medium_ratio")
        self.assertEqual(float(option["default"]), 0.1)
        self.assertTrue(lamella("explain", "bubble", "--markdown").stdout.startswith("| option |"))

    def test_explain_names_the_option_that_was_meant(self):
        self.assert_refused(lamella("explain", "buble"), "did you mean bubble?")
        self.assert_refused(lamella("explain", "bubble.gas.medium_ration"), "did you mean bubble.gas.medium_ratio?")
        self.assert_refused(lamella("explain", "bubble.medium_ratio"), "did you mean bubble.gas.medium_ratio?")

    def test_explain_shows_the_colors_of_films(self):
        text = lamella("explain", "colors").stdout
        self.assertIn("#000000  black", text)
        rows = json.loads(lamella("explain", "colors", "--json").stdout)
        self.assertEqual([round(1e9 * row["thickness"]) for row in rows[:3]], [0, 20, 40])
        self.assertLess(abs(rows[5]["reflectance"] - 0.0775), 1e-3)
        self.assert_exit(lamella("explain", "colors", "--light", "3000 K", "--out", self.folder / "c.png"), 0)
        self.assertTrue((self.folder / "c.png").read_bytes().startswith(b"\x89PNG"))
        self.assert_refused(lamella("explain", "colors", "--light", "neon"), "D65")
        self.assert_refused(lamella("explain", "colors", "--out", self.folder / "c.jpg"), ".png")
        self.assert_refused(lamella("explain", "bubble", "--out", "x.png"), "colors")

    def test_version_says_what_is_in(self):
        self.assertRegex(lamella("version").stdout, r"^lamella \d+\.\d+\.\d+")
        self.assertIn("bubble", json.loads(lamella("version", "--json").stdout)["solvers"])

    def test_import_writes_a_scene_that_can_be_checked(self):
        [source, *_] = sorted((DATA / "import").glob("*.json"))
        self.assert_exit(lamella("import", source, "--out", self.folder / "imported.toml"), 0)
        self.assert_exit(lamella("check", self.folder / "imported.toml"), 0)
        self.assertEqual(lamella("import", source, "--out", "-").stdout, (self.folder / "imported.toml").read_text())
        self.assert_refused(lamella("import", self.scene, "--out", self.folder / "no.toml"))
        self.assertFalse((self.folder / "no.toml").exists())

    def test_reading_what_is_no_run_is_refused(self):
        for command in (["measure", self.folder], ["plot", self.folder], ["export", self.folder, "--to", "csv"],
                        ["resume", self.folder], ["measure", self.scene]):
            self.assert_refused(lamella(*command))


class ForeignSeries(ProgramTest):
    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed")
    def test_of_any_solver_is_drawn_column_by_column(self):
        run = self.folder / "run"
        run.mkdir()
        (run / "scene.toml").write_text("")
        (run / "run.json").write_text("{}")
        (run / "series.csv").write_text("time[s],total_area[m^2],it's_odd[-],empty[-]\n"
                                        "0,1.5,3,nan\n0.1,1.25,4,nan\n0.2,1.125,nan,nan\n")
        self.assert_exit(lamella("plot", run), 0)
        self.assertEqual({path.name for path in (run / "plots").iterdir()}, {"total_area.png", "it's_odd.png"})
        self.assert_exit(lamella("plot", run, "--out", self.folder / "all.png"), 0)


class Streams(ProgramTest):
    def test_a_reader_that_goes_away_is_no_error(self):
        with subprocess.Popen([PROGRAM, "explain", "bubble"], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            process.stdout.close()
            self.assertEqual(process.wait(timeout=30), 0)
            self.assertEqual(process.stderr.read(), b"")

    def test_a_full_disk_behind_stdout_is_one(self):
        with open("/dev/full", "w", encoding="utf8") as full:
            result = subprocess.run([PROGRAM, "explain", "bubble"], stdout=full, stderr=subprocess.PIPE, check=False)
        self.assertEqual(result.returncode, 4)
        self.assertIn(b"No space left", result.stderr)


if __name__ == "__main__":
    unittest.main()
