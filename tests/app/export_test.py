"""Frames for programs that draw: lamella export with normals, thickness and color."""

import json
import struct
import unittest

from program import ProgramTest, lamella


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

    def test_usda_and_obj_go_to_a_pipe(self):
        run = self.films()
        text = lamella("export", run, "--to", "usda", "--frame", "last", "--out", "-").stdout
        self.assertTrue(text.startswith("#usda 1.0\n"))
        self.assertIn("primvars:thickness_nm", text)
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
