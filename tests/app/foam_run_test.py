"""One small foam, through everything that a run folder is for."""

import csv
import io
import json
import math
import shutil
import unittest

from program import ProgramTest, lamella, results


def read_series(folder):
    return list(csv.DictReader(io.StringIO((folder / "series.csv").read_text())))


class FoamRun(ProgramTest):

    def run_foam(self, name="run", *arguments):
        folder = self.folder / name
        result = lamella("run", self.scene, "--out", folder, *arguments)
        self.assert_exit(result, 0)
        return folder, result

    def test_leaves_everything_in_its_folder(self):
        folder, result = self.run_foam()
        for name in ("scene.toml", "run.json", "series.csv", "events.csv", "frames.pvd", "checkpoint.h5", "log.txt"):
            self.assertTrue((folder / name).is_file(), name)
        self.assertEqual(len(list((folder / "frames").iterdir())), 9)
        self.assertEqual(result.stdout, "")
        for text in ("a small foam", "bubble", "threads", str(folder), "Done in"):
            self.assertIn(text, result.stderr)

        record = json.loads((folder / "run.json").read_text())
        self.assertEqual(record["state"], "finished")
        self.assertEqual(record["seed"], 5)
        self.assertRegex(record["start"], r"^\d{4}-\d\d-\d\dT")

        rows = read_series(folder)
        self.assertEqual([float(row["time[-]"]) for row in rows], [k / 20 for k in range(81)])
        self.assertLess(abs(float(rows[-1]["volume_error[-]"])), 1e-12)
        self.assertLess(float(rows[-1]["bubbles[-]"]), float(rows[0]["bubbles[-]"]))

    def test_is_the_same_on_one_and_two_threads_and_from_its_own_scene(self):
        one, _ = self.run_foam("one", "--threads", "1")
        two, _ = self.run_foam("two", "--threads", "2")
        self.assert_same_results(one, two)
        self.assert_exit(lamella("run", one / "scene.toml", "--out", self.folder / "again"), 0)
        self.assert_same_results(one, self.folder / "again")

    def test_can_be_measured_exported_and_resumed(self):
        folder, _ = self.run_foam()
        measured = json.loads(lamella("measure", folder, "--json").stdout)
        self.assertEqual(measured["solver"], "bubble")
        self.assertEqual(measured["time"], 4.0)
        for key in ("step", "scaled_time", "bubbles", "gas_fraction", "mean_radius", "max_radius", "mean_contacts",
                    "rattlers", "volume_error", "stress", "exponent", "energy"):
            self.assertIn(key, measured)
        self.assertAlmostEqual(measured["gas_fraction"], 0.95, places=12)
        self.assertIn("total", measured["energy"])
        self.assertIn("xy", measured["stress"])
        last = read_series(folder)[-1]
        self.assertTrue(math.isclose(measured["exponent"], float(last["exponent[-]"])))
        self.assertEqual(measured["mean_radius"], float(last["mean_radius[-]"]))

        first = json.loads(lamella("measure", folder, "--frame", "0", "--json").stdout)
        self.assertEqual(first["time"], 0.0)
        self.assertEqual(json.loads(lamella("measure", folder / "frames" / "000000.vtp", "--json").stdout)["bubbles"],
                         first["bubbles"])
        self.assert_refused(lamella("measure", folder, "--frame", "9"), "0 to 8")

        table = lamella("export", folder, "--to", "csv", "--frame", "last", "--out", "-").stdout
        self.assertEqual(len(list(csv.DictReader(io.StringIO(table)))), measured["bubbles"])
        for form in ("csv", "xyz", "ply", "vtp"):
            self.assert_exit(lamella("export", folder, "--to", form, "--out", self.folder / form), 0)
            self.assertEqual(len(list((self.folder / form).iterdir())), 9)
        self.assert_refused(lamella("export", folder, "--to", "cvs"), "did you mean csv?")
        self.assert_refused(lamella("export", folder, "--to", "csv", "--out", "-"), "--frame")

        before = results(folder)
        result = lamella("resume", folder)
        self.assert_exit(result, 0)
        self.assertIn("Nothing to do", result.stderr)
        self.assertEqual(results(folder), before)
        self.assert_exit(lamella("resume", folder, "--until", "4.5"), 0)
        self.assertEqual(json.loads(lamella("measure", folder, "--json").stdout)["time"], 4.5)

    def test_is_not_replaced_by_accident(self):
        folder, _ = self.run_foam("run", "--until", "0.5")
        before = results(folder)
        self.assert_refused(lamella("run", self.scene, "--out", folder), "lamella resume", "--overwrite")
        self.assertEqual(results(folder), before)
        self.assert_exit(lamella("run", self.scene, "--out", folder, "--until", "1", "--overwrite"), 0)
        self.assertNotEqual(results(folder), before)
        self.assert_refused(lamella("run", self.scene, "--out", self.folder, "--overwrite"), "not a run's")
        self.assertTrue(self.scene.exists())

    def test_says_when_it_follows_the_published_program_instead_of_the_physics(self):
        _, result = self.run_foam("run", "--until", "0.1", "--set", "bubble.compat.energy=true")
        self.assertIn("bubble.compat.energy = true (default false)", result.stderr)

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed")
    def test_can_be_plotted(self):
        self.scene.write_text(self.scene.read_text().replace("a small foam", "`touch pwned`'; system \\\"touch pwned\\\" #"))
        folder, _ = self.run_foam()
        self.assert_exit(lamella("plot", folder, cwd=self.folder), 0)
        pictures = {path.name for path in (folder / "plots").iterdir()}
        self.assertEqual(pictures, {name + ".png" for name in ("growth", "energy", "avalanches", "bubbles", "sizes",
                                                               "gas_fraction", "snapshot")})
        for path in (folder / "plots").iterdir():
            self.assertEqual(path.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        for color in ("radius", "energy", "displacement"):
            picture = self.folder / f"{color}.svg"
            self.assert_exit(lamella("plot", folder, "--out", picture, "--color", color, "--frame", "2"), 0)
            self.assertIn("</svg>", picture.read_text())
        self.assert_refused(lamella("plot", folder, "--out", self.folder / "x.gif"), ".png or .svg")
        self.assert_refused(lamella("plot", folder, "--panel", "snapshto"), "did you mean snapshot?")
        self.assertFalse((self.folder / "pwned").exists())

    def test_without_gnuplot_says_what_is_missing(self):
        folder, _ = self.run_foam("run", "--until", "0.5")
        result = lamella("plot", folder, env={"PATH": str(self.folder)})
        self.assert_exit(result, 4)
        self.assertIn("gnuplot", result.stderr)
        self.assertFalse((folder / "plots").exists() and list((folder / "plots").iterdir()))


if __name__ == "__main__":
    unittest.main()
