"""The scene that run.sh shows when nobody names another: how long it takes, and what it leaves."""

import csv
import json
import resource
import unittest

from program import ProgramTest, lamella


class SheetRun(ProgramTest):

    def test_the_default_scene_takes_less_than_a_minute(self):
        def cpu():
            usage = resource.getrusage(resource.RUSAGE_CHILDREN)
            return usage.ru_utime + usage.ru_stime

        before = cpu()
        folder = self.folder / "run"
        self.assert_exit(lamella("run", "vortex_sheet/double-bubble-small", "--out", folder), 0)
        # CPU time of all threads: on two cores it takes no longer than that, however busy they are with other work.
        self.assertLess(cpu() - before, 60.0)
        measured = json.loads(lamella("measure", folder, "--json").stdout)
        self.assertEqual(measured["mesh"]["intersections"], 0)
        self.assertEqual(len(measured["regions"]), 2)
        self.assertLess(measured["volume_error"], 1e-6)
        with open(folder / "series.csv", encoding="utf-8") as file:
            energy = [float(row["energy[J]"]) for row in csv.DictReader(file)]
        self.assertLess(max(energy), 1.01 * energy[0])


if __name__ == "__main__":
    unittest.main()
