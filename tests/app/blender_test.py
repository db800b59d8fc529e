"""What lamella exports, loaded and drawn by Blender without a screen (Debian: blender). Skipped where it is missing."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

from program import ProgramTest, lamella

SCRIPT = pathlib.Path(os.environ["LAMELLA_SOURCE"]) / "tools" / "blender" / "import_lamella.py"


# Debian's Blender looks for its Python modules beside the first python3 on the PATH: it must be Debian's.
ENVIRONMENT = os.environ | {"PATH": os.pathsep.join(("/usr/bin", "/bin", os.environ["PATH"]))}


class Blender(ProgramTest):

    def blender(self, *arguments, script=SCRIPT):
        return subprocess.run(["blender", "--background", "--factory-startup", "--python", script, "--", *map(str, arguments)],
                              capture_output=True, text=True, check=False, timeout=500, env=ENVIRONMENT)

    def report(self, result):
        self.assert_exit(result, 0)
        lines = [line for line in result.stdout.splitlines() if line.startswith("lamella ")]
        self.assertEqual(len(lines), 1, result.stdout + result.stderr)
        return json.loads(lines[0].removeprefix("lamella "))

    def test_shows_a_sequence_of_films_with_their_attributes(self):
        run, sequence, picture = self.folder / "run", self.folder / "sequence", self.folder / "film.png"
        self.assert_exit(lamella("run", "vortex_sheet/double-bubble-small", "--out", run, "--until", "0.02"), 0)
        self.assert_exit(lamella("export", run, "--to", "ply", "--baked", "--rate", "200", "--out", sequence), 0)
        report = self.report(self.blender(sequence, "--report", "--render", picture, "--size", "64x48", "--samples", "4",
                                          "--save", self.folder / "film.blend"))
        self.assertEqual(report["files"], 5)
        header = (sequence / "000000.ply").read_bytes().split(b"end_header")[0].decode().split()
        self.assertEqual(report["vertices"], int(header[header.index("vertex") + 1]))
        self.assertLessEqual({"color", "region_back", "region_front", "thickness_nm", "velocity"}, set(report["attributes"]))
        self.assertEqual(report["material"], "soap film")
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertTrue((self.folder / "film.blend").exists())

    def test_shows_bubbles(self):
        run, file = self.folder / "run", self.folder / "foam.ply"
        self.assert_exit(lamella("run", self.scene, "--out", run), 0)
        self.assert_exit(lamella("export", run, "--to", "ply", "--baked", "--frame", "last", "--out", file), 0)
        header = file.read_bytes().split(b"end_header")[0].decode().split()
        self.assertEqual(self.report(self.blender(file, "--report"))["bubble_vertices"],
                         42 * int(header[header.index("vertex") + 1]))

    def test_takes_films_and_solids_from_gltf(self):
        """Blender's own importer: one object per film and one for the stick, in meters, with the thickness of each vertex."""
        run, file = self.folder / "run", self.folder / "stick.glb"
        self.assert_exit(lamella("run", "vortex_particle/stick-small", "--out", run, "--until", "0.05"), 0)
        self.assert_exit(lamella("export", run, "--to", "glb", "--frame", "last", "--out", file), 0)
        script = self.folder / "look.py"
        script.write_text(f"""import bpy, json, numpy, sys
numpy.bool = bool  # Debian 12's importer uses a name that its numpy has dropped
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath={str(file)!r})
seen = {{o.name: {{"size": list(o.dimensions), "at": [sum(v.co[k] for v in o.data.vertices) / len(o.data.vertices) for k in range(3)],
                  "colors": len(o.data.color_attributes)}} for o in bpy.data.objects if o.type == "MESH"}}
print("lamella " + json.dumps(seen))
""")
        seen = self.report(self.blender(script=script))
        films = [name for name in seen if name.startswith("film_")]
        self.assertEqual(sorted(seen), sorted([*films, "solids"]))
        self.assertEqual(len(films), 1)
        for film in films:
            for size, expected in zip(seen[film]["size"], (3.2, 1.0, 0.0)):
                self.assertAlmostEqual(size, expected, delta=1e-5)
            self.assertGreater(seen[film]["colors"], 0)
        for k, (place, expected) in enumerate(zip(seen["solids"]["at"], (0.45, 0.503, 0.0))):
            self.assertAlmostEqual(place, expected, delta=1e-5)
            self.assertAlmostEqual(seen["solids"]["size"][k], 0.2, delta=1e-3)

    def test_says_what_it_cannot_read(self):
        result = self.blender(self.folder / "foam.toml")
        self.assert_exit(result, 1)
        self.assertIn("no binary PLY", result.stderr)


if __name__ == "__main__":
    if shutil.which("blender") is None:
        print("blender is not installed: what it makes of lamella's files is not tested")
        sys.exit(77)
    probe = subprocess.run(["blender", "--background", "--python-expr", "import numpy"], capture_output=True, text=True,
                           env=ENVIRONMENT)
    if "No module named 'numpy'" in probe.stdout + probe.stderr:
        print("Blender's Python has no numpy (python3-numpy): what it makes of lamella's files is not tested")
        sys.exit(77)
    unittest.main()
