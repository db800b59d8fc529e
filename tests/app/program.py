"""What the tests of the program share: calling it, small foams, comparing run folders."""

import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["LAMELLA"]
DATA = pathlib.Path(os.environ["LAMELLA_TEST_DATA"])

# 400 bubbles coarsen to about 150: a second or so, a frame and a few rows every half unit of time.
SMALL_FOAM = """
title  = "a small foam"
solver = "bubble"
seed   = 5

[time]
end = 4.0
frame_rate = 2.0
series_rate = 20.0

[output]
checkpoint_interval = 0.05

[bubble]
count = 400
end_count = 20
"""


def lamella(*arguments, **options):
    """Runs the program to its end; its streams as text."""
    options.setdefault("timeout", 120)
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False, **options)


def results(folder):
    """Contents of every file of a run that must not depend on how the run went."""
    folder = pathlib.Path(folder)
    files = [folder / name for name in ("series.csv", "events.csv", "frames.pvd")]
    files += sorted((folder / "frames").iterdir())
    return {str(file.relative_to(folder)): file.read_bytes() for file in files}


class ProgramTest(unittest.TestCase):
    """A test case with an empty folder of its own."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="lamella_app_")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.scene = self.folder / "foam.toml"
        self.scene.write_text(SMALL_FOAM)

    def assert_exit(self, result, code):
        self.assertEqual(result.returncode, code, f"{result.args}\n{result.stdout}\n{result.stderr}")

    def assert_refused(self, result, *words):
        """Exit code 2, nothing on stdout, one line on stderr that has the given words."""
        self.assert_exit(result, 2)
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertTrue(result.stderr.startswith("lamella: "), result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def assert_same_results(self, a, b):
        found, expected = results(a), results(b)
        self.assertEqual(sorted(found), sorted(expected))
        for name, content in expected.items():
            self.assertEqual(found[name], content, f"{name} differs")
