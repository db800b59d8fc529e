"""A film run through measure and plot: what people and programs read of it."""

import csv
import io
import json
import math
import shutil
import unittest

from program import ProgramTest, lamella

AREA = 13.1281682444334  # three bubbles of volume 1, film tension 1
PRESSURE = 2.91737072098521


class FilmRun(ProgramTest):

    def run_films(self, *arguments):
        folder = self.folder / "run"
        self.assert_exit(lamella("run", "equilibrium/triple-bubble-small", "--out", folder, *arguments), 0)
        return folder

    def test_is_measured_as_one_nested_object(self):
        folder = self.run_films()
        measured = json.loads(lamella("measure", folder, "--json").stdout)
        self.assertEqual(measured["solver"], "equilibrium")
        self.assertLess(abs(measured["area"] / AREA - 1), 2e-6)
        self.assertLess(abs(measured["estimated_area"] / AREA - 1), 3e-6)
        self.assertEqual(measured["total_area"], measured["polyhedral_area"])
        self.assertAlmostEqual(measured["energy"]["surface"], measured["area"], places=12)
        self.assertEqual(set(measured["film_area"]), {"0-1", "0-2", "0-3", "1-2", "1-3", "2-3"})
        self.assertAlmostEqual(sum(measured["film_area"].values()), measured["total_area"], places=10)
        self.assertEqual([region["id"] for region in measured["regions"]], [1, 2, 3])
        for region in measured["regions"]:
            self.assertAlmostEqual(region["volume"], 1.0, places=9)
            self.assertLess(abs(region["pressure"] / PRESSURE - 1), 1e-4)
            self.assertEqual(len(region["centroid"]), 3)
        self.assertLess(measured["volume_error"], 1e-9)
        self.assertEqual(measured["edge_angles"]["method"], "quadratic")
        self.assertAlmostEqual(measured["edge_angles"]["mean"], 120.0, places=6)
        self.assertLess(measured["edge_angles"]["mean_error"], 0.5)
        self.assertLess(measured["edge_angles"]["max_error"], 1.5)
        self.assertGreater(measured["edge_angles"]["flat"]["max_error"], measured["edge_angles"]["max_error"])
        self.assertEqual(measured["corner_angles"]["count"], 2)
        self.assertLess(measured["corner_angles"]["max_error"], 0.5)
        outer = measured["film_curvature"]["0-1"]
        self.assertLess(abs(outer["mean"] / PRESSURE - 1), 5e-3)
        self.assertLess(abs(outer["fit_radius"] * PRESSURE / 2 - 1), 2e-2)
        self.assertEqual(measured["mesh"]["intersections"], 0)
        for key in ("vertices", "faces", "mean_edge", "min_angle"):
            self.assertGreater(measured["mesh"][key], 0)

    def test_is_measured_from_a_file_and_from_a_pipe(self):
        folder = self.run_films()
        file = sorted((folder / "frames").iterdir())[-1]
        expected = lamella("measure", folder, "--json").stdout
        self.assertEqual(lamella("measure", file, "--json").stdout, expected)
        self.assertEqual(lamella("measure", "-", "--json", input=file.read_text()).stdout, expected)
        table = lamella("measure", file).stdout
        for text in ("total_area", "pressure [Pa]", "between films", "between lines", "curvature [1/m]"):
            self.assertIn(text, table)
        self.assert_exit(lamella("measure", "-", input="solid cube"), 2)

    def test_has_its_measures_in_the_series_and_pictures_of_them(self):
        folder = self.run_films()
        rows = list(csv.DictReader(io.StringIO((folder / "series.csv").read_text())))
        last = rows[-1]
        self.assertAlmostEqual(float(last["gas_volume[m^3]"]), 3.0, places=9)
        self.assertAlmostEqual(float(last["volume_2[m^3]"]), 1.0, places=9)
        self.assertLess(float(last["edge_angle_max_error[deg]"]), 1.5)
        self.assertTrue(math.isnan(float(rows[0]["pressure_1[Pa]"])))
        if shutil.which("gnuplot") is None:
            return
        self.assert_exit(lamella("plot", folder), 0)
        for name in ("area", "volumes", "pressures", "angles", "accuracy", "mesh"):
            picture = (folder / "plots" / f"{name}.png").read_bytes()
            self.assertTrue(picture.startswith(b"\x89PNG"), name)


if __name__ == "__main__":
    unittest.main()
