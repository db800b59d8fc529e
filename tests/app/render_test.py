"""Pictures: what lamella render writes, for films and for foams."""

import json
import shutil
import struct
import subprocess
import sys
import unittest
import zlib

from program import ProgramTest, lamella

SMALL = ("--size", "80x60", "--samples", "4", "--progress", "none")


def read_png(path):
    """Width, height, bits, channels and the rows of values of a PNG without interlacing."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    place, pixels = 8, b""
    while place < len(data):
        size, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + size]
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack(">IIBB", body[:10])
        if kind == b"IDAT":
            pixels += body
        place += 12 + size
    channels = {2: 3, 6: 4}[color]
    step, raw = channels * bits // 8, zlib.decompress(pixels)
    stride, rows, before = width * step, [], bytearray(width * step)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left = row[i - step] if i >= step else 0
            corner = before[i - step] if i >= step else 0
            guess = left + before[i] - corner
            paeth = min((left, before[i], corner), key=lambda v: abs(guess - v))
            row[i] = (row[i] + (0, left, before[i], (left + before[i]) // 2, paeth)[kind]) & 255
        rows.append([int.from_bytes(row[i:i + bits // 8], "big") for i in range(0, stride, bits // 8)])
        before = row
    return width, height, bits, channels, rows


class Pictures(ProgramTest):

    def render(self, *arguments, code=0):
        result = lamella("render", *arguments, *SMALL)
        self.assert_exit(result, code)
        return result

    def films(self):
        folder = self.folder / "films"
        self.assert_exit(lamella("run", "equilibrium/frame-cube-small", "--out", folder), 0)
        return folder

    def foam(self):
        folder = self.folder / "foam"
        self.assert_exit(lamella("run", self.scene, "--out", folder), 0)
        return folder

    def test_of_films_are_colorful_and_say_how_they_were_made(self):
        run = self.films()
        self.assertTrue(self.render(run).stderr.strip().endswith(".png"))
        file = sorted((run / "pictures").glob("*.png"))[-1]
        width, height, bits, channels, rows = read_png(file)
        self.assertEqual((width, height, bits, channels), (80, 60, 8, 3))
        spread = [max(row[i:i + 3]) - min(row[i:i + 3]) for row in rows for i in range(0, len(row), 3)]
        self.assertGreater(sum(s > 60 for s in spread), 300)
        notes = json.loads(file.with_suffix(".json").read_text())
        self.assertTrue(notes["thickness"].startswith("assumed:"), notes)
        self.assertEqual((notes["width"], notes["samples"]), (80, 4))

    def test_are_the_same_on_any_number_of_threads(self):
        run = self.films()
        contents = set()
        for threads in (1, 2, 3):
            out = self.folder / f"{threads}.png"
            self.render(run, "--out", out, "--threads", threads)
            contents.add(out.read_bytes())
        self.assertEqual(len(contents), 1)

    def test_show_the_color_of_a_thickness(self):
        """A square film from above in even light: 300 nm is amber-purple and not gray, 4 nm is black."""
        film = self.folder / "square.obj"
        film.write_text("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n")
        middle = {}
        for thickness in ("4 nm", "300 nm"):
            out = self.folder / "film.png"
            self.render(film, "--thickness", thickness, "--camera", "-90,90", "--environment", "gray", "--background",
                        "#000000", "--borders", "0", "--exposure", "12", "--out", out)
            middle[thickness] = read_png(out)[4][30][120:123]
        self.assertLess(max(middle["4 nm"]), 40)
        red, green, blue = middle["300 nm"]
        self.assertGreater(max(red, green, blue) - min(red, green, blue), 40, middle)

    def test_can_have_sixteen_bits_and_no_background(self):
        run = self.films()
        out = self.folder / "film.png"
        self.render(run, "--out", out, "--bits", "16", "--background", "transparent")
        width, _, bits, channels, rows = read_png(out)
        self.assertEqual((width, bits, channels), (80, 16, 4))
        alpha = [value for row in rows for value in row[3::4]]
        self.assertEqual(alpha[0], 0)
        self.assertEqual(max(alpha), 65535)  # a wire
        self.assertGreater(len(set(alpha)), 50)

    def test_can_be_openexr(self):
        if "exr" not in lamella("version").stdout:
            self.skipTest("built without OpenEXR")
        run, out = self.films(), self.folder / "film.exr"
        self.render(run, "--out", out)
        self.assertEqual(out.read_bytes()[:4], b"\x76\x2f\x31\x01")
        self.render(run, "--frame", "all", "--format", "exr", "--out", self.folder / "sequence")
        self.assertTrue((self.folder / "sequence" / "000000.exr").exists())

    def test_of_a_foam_show_a_field_with_a_legend(self):
        run = self.foam()
        plain, colored = self.folder / "plain.png", self.folder / "radius.png"
        self.render(run, "--out", plain)
        self.render(run, "--out", colored, "--field", "radius")
        self.assertNotEqual(plain.read_bytes(), colored.read_bytes())
        notes = json.loads(colored.with_suffix(".json").read_text())
        self.assertEqual(notes["field"]["name"], "radius")
        self.assertLess(notes["field"]["low"], notes["field"]["high"])
        self.assertEqual(notes["camera"]["elevation_deg"], 90.0)  # what is flat is seen from above

    def test_of_all_frames_share_one_camera_and_make_a_film(self):
        run = self.films()
        out, video = self.folder / "sequence", self.folder / "film.mp4"
        self.render(run, "--frame", "all", "--out", out)
        frames = len(list((run / "frames").iterdir()))
        self.assertEqual(len(list(out.glob("*.png"))), frames)
        self.assertEqual(len(json.loads((out / "pictures.json").read_text())), frames)
        if shutil.which("ffmpeg") is None:
            result = self.render(run, "--video", video, code=4)
            self.assertIn("apt install ffmpeg", result.stderr)
            return
        self.render(run, "--video", video, "--rate", "5")
        self.assertEqual(video.read_bytes()[4:8], b"ftyp")
        probe = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames,width", "-of",
                                "json", video], capture_output=True, text=True, check=True)
        stream = json.loads(probe.stdout)["streams"][0]
        self.assertEqual((stream["width"], int(stream["nb_read_frames"])), (80, frames))

    def test_of_a_scene_show_its_start(self):
        result = lamella("render", "equilibrium/double-bubble-small", *SMALL, cwd=self.folder)
        self.assert_exit(result, 0)
        self.assertTrue((self.folder / "double-bubble-small.png").exists())

    def test_with_mistakes_are_refused(self):
        run = self.films()
        for arguments, words in ((("--size", "80"), "1920x1080"), (("--size", "0x10"), "16384"), (("--camera", "1"), "AZIMUTH"),
                                 (("--field", "presure"), "no field presure"), (("--environment", "studoi"), "did you mean studio?"),
                                 (("--background", "blue"), "#1a2b3c"), (("--out", "a.bmp"), ".png or .exr"),
                                 (("--frame", "900"), "900"), (("--thickness", "3 kg"), "3 kg"), (("--video", "a.avi"), ".mp4"),
                                 (("--samples", "0"), "samples"),
                                 (("--frame", "all", "--out", "a.png"), "folder"),
                                 (("--video", "a.mp4", "--format", "exr"), ".png"), (("--environment", "no.hdr"), "")):
            result = lamella("render", run, *arguments, "--progress", "none", cwd=self.folder)
            if words:
                self.assert_refused(result, words)
            else:
                self.assert_exit(result, 4)
        self.assert_refused(lamella("render", "no-such-run"), "no-such-run")


if __name__ == "__main__":
    if "render" not in lamella("version").stdout:
        print("lamella was built without Embree; pictures are not tested")
        sys.exit(77)
    unittest.main()
