"""Frames for programs that draw: lamella export with normals, thickness and color."""

import json
import struct
import unittest

from program import ProgramTest, lamella
from usda_reader import UsdError, read_usda


class Drawing(ProgramTest):

    def films(self):
        run = self.folder / "films"
        self.assert_exit(lamella("run", "equilibrium/triple-bubble-small", "--out", run), 0)
        return run

    def foam(self):
        run = self.folder / "foam"
        self.assert_exit(lamella("run", self.scene, "--out", run), 0)
        return run

    def test_glb_has_a_mesh_per_film(self):
        out = self.folder / "films.glb"
        self.assert_exit(lamella("export", self.films(), "--to", "glb", "--frame", "last", "--out", out), 0)
        data = out.read_bytes()
        magic, version, size, length, kind = struct.unpack("<4sIII4s", data[:20])
        self.assertEqual((magic, version, size, kind), (b"glTF", 2, len(data), b"JSON"))
        scene = json.loads(data[20:20 + length])
        self.assertEqual(sorted(mesh["name"] for mesh in scene["meshes"]),
                         ["film_0_1", "film_0_2", "film_0_3", "film_1_2", "film_1_3", "film_2_3"])
        for mesh in scene["meshes"]:
            attributes = mesh["primitives"][0]["attributes"]
            self.assertLessEqual({"POSITION", "NORMAL", "COLOR_0", "_THICKNESS_NM"}, set(attributes))
            self.assertEqual({scene["accessors"][a]["count"] for a in attributes.values()},
                             {scene["accessors"][attributes["POSITION"]]["count"]})
        for view in scene["bufferViews"]:
            self.assertLessEqual(view["byteOffset"] + view["byteLength"], scene["buffers"][0]["byteLength"])

    def test_ply_is_baked_only_when_asked(self):
        run = self.films()
        headers = []
        for arguments in ((), ("--baked",)):
            out = self.folder / "films.ply"
            self.assert_exit(lamella("export", run, "--to", "ply", "--frame", "last", "--out", out, *arguments), 0)
            headers.append(out.read_bytes().split(b"end_header")[0].decode())
        self.assertNotIn("thickness_nm", headers[0])
        for line in ("property double nx", "property double thickness_nm", "property uchar red", "comment thickness_assumed 1"):
            self.assertIn(line, headers[1])

    def usda(self, run):
        result = lamella("export", run, "--to", "usda", "--frame", "last", "--out", "-")
        self.assert_exit(result, 0)
        return result.stdout

    def test_usda_of_films_is_what_usd_takes(self):
        root, metadata = read_usda(self.usda(self.films()))
        self.assertEqual((metadata["metersPerUnit"], metadata["upAxis"]), ("1", '"Z"'))
        self.assertEqual([(child.kind, child.name) for child in root.children], [("Mesh", "films")])
        films = root.children[0]
        self.assertLessEqual({"primvars:thickness_nm", "primvars:displayColor", "normals"}, set(films.attributes))
        points, corners, normals = (films.value(name) for name in ("points", "faceVertexIndices", "normals"))
        back, front = films.value("primvars:region_back"), films.value("primvars:region_front")
        self.assertEqual(set(zip(back, front)), {(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)})
        volume = dict.fromkeys(range(4), 0.0)  # of each region, by its films: USD's corners go counterclockwise around normals
        for face, (b, f) in enumerate(zip(back, front)):
            p, q, r = (points[int(c)] for c in corners[3 * face:3 * face + 3])
            six = sum(p[i] * (q[j] * r[k] - q[k] * r[j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
            volume[b] += six / 6
            volume[f] -= six / 6
            facing = [(q[i] - p[i]) * (r[j] - p[j]) - (q[j] - p[j]) * (r[i] - p[i]) for i, j in ((1, 2), (2, 0), (0, 1))]
            normal = normals[int(corners[3 * face])]
            self.assertGreater(sum(a * c for a, c in zip(facing, normal)), 0.0)
        for region in (2, 3):
            self.assertAlmostEqual(volume[region] / volume[1], 1.0, delta=1e-3)  # three bubbles of one size

    def test_usda_of_balls_and_solids_is_what_usd_takes(self):
        root, _ = read_usda(self.usda(self.foam()))
        balls = root.children[0]
        self.assertEqual((balls.kind, len(root.children)), ("Points", 1))
        self.assertEqual(len(balls.value("widths")), len(balls.value("points")))
        run = self.folder / "stick"
        self.assert_exit(lamella("run", "vortex_particle/stick-small", "--out", run, "--until", "0.1"), 0)
        root, _ = read_usda(self.usda(run))
        self.assertEqual([child.name for child in root.children], ["films", "solid_0"])
        stick = root.children[1]
        self.assertEqual(stick.value("radius"), 0.1)
        for x, expected in zip(stick.value("xformOp:translate"), (0.5, 0.503, 0.0)):  # 1 m/s for 0.1 s
            self.assertAlmostEqual(x, expected, delta=1e-9)

    def test_the_reader_of_usda_refuses_what_usd_would(self):
        text = self.usda(self.films())
        read_usda(text)
        for before, after in (("#usda 1.0", "#usda"), ("point3f[] points = [(", "point3f[] points = [(0, 0, 0), ("),
                              ("int[] faceVertexCounts = [3", "int[] faceVertexCounts = [4"), ("= [(", "= [((", ), ('"vertex"', '"uniform"'),
                              ("normal3f[] normals", "normals3f[] normals"), ('def Mesh "films"', 'def Mesh "the films"'),
                              ("primvars:region_back", "region_back"), ("faceVertexIndices = [", "faceVertexIndices = [-1, "),
                              ("float3[] extent = [(", "float3[] extent = [(9"), ("\n}\n", "\n"), ("uniform bool", "bool")):
            self.assertIn(before, text)
            with self.assertRaises(UsdError, msg=after):
                read_usda(text.replace(before, after, 1))

    def test_obj_goes_to_a_pipe(self):
        run = self.films()
        text = lamella("export", run, "--to", "obj", "--baked", "--frame", "last", "--out", "-").stdout
        self.assertIn("\nvn ", text)

    def test_sequences_have_a_constant_rate(self):
        """The foam's frames are 0.5 apart; a rate of 8 shows each four times, a rate of 1 every other."""
        run = self.foam()
        frames = len(list((run / "frames").iterdir()))
        for rate, expected in ((8, 4 * (frames - 1) + 1), (1, (frames - 1) // 2 + 1)):
            out = self.folder / f"rate{rate}"
            self.assert_exit(lamella("export", run, "--to", "usda", "--rate", rate, "--out", out), 0)
            files = sorted(out.iterdir())
            self.assertEqual(len(files), expected)
            self.assertIn("custom double time = 0\n", files[0].read_text())
            self.assertIn("custom double time = 4\n", files[-1].read_text())

    def test_with_mistakes_is_refused(self):
        run = self.foam()
        self.assert_refused(lamella("export", run, "--to", "gbl"), "did you mean glb?")
        self.assert_refused(lamella("export", run, "--to", "glb", "--field", "presure"), "did you mean pressure?")
        self.assert_refused(lamella("export", run, "--to", "obj", "--baked"), "no films")
        self.assert_refused(lamella("export", run, "--to", "usda", "--rate", "1e9"), "--rate")


if __name__ == "__main__":
    unittest.main()
