"""Films from files, as users meet them: `lamella import` and what its scenes come to."""

import math
import shutil
import unittest

from program import DATA, ProgramTest, lamella, results

# A catenoid between rings of radius 1 with separation 0.8: 4 pi times the integral of its profile.
CATENOID_AREA = 4.883793201931147


def catenoid_datafile(count):
    """Two rings on boundary curves and a cylinder between them, as a Surface Evolver datafile."""
    lines = ["PARAMETER ring = 1", "PARAMETER half = 0.8/2"]
    for number, sign in ((1, ""), (2, "-")):
        lines += [f"BOUNDARY {number} PARAMETERS 1", "x1: ring*cos(p1)", "x2: ring*sin(p1)", f"x3: {sign}half"]
    lines.append("vertices")
    for ring in range(2):
        lines += [f"{ring * count + k + 1} 2*pi*{k}/{count} boundary {ring + 1} fixed" for k in range(count)]
    lines.append("edges")
    for ring in range(2):
        base = ring * count
        lines += [f"{base + k + 1} {base + k + 1} {base + (k + 1) % count + 1} boundary {ring + 1} fixed"
                  for k in range(count)]
    lines += [f"{2 * count + k + 1} {k + 1} {count + k + 1}" for k in range(count)]
    lines.append("faces")
    lines += [f"{k + 1} {k + 1} {2 * count + (k + 1) % count + 1} -{count + k + 1} -{2 * count + k + 1}"
              for k in range(count)]
    return "\n".join(lines) + "\nread\n"


class ImportedFilms(ProgramTest):
    def imported(self, name, text=None):
        """The scene made from tests/data/films/NAME, or from `text`, copied to a folder of its own."""
        file = self.folder / name
        if text is None:
            shutil.copy(DATA / "films" / name, file)
        else:
            file.write_text(text)
        scene = file.with_suffix(".toml")
        self.assert_exit(lamella("import", file, "--out", scene), 0)
        return scene

    def area_at_rest(self, scene):
        run = scene.with_suffix("")
        self.assert_exit(lamella("run", scene, "--out", run, "--progress", "none"), 0)
        header, *rows = (run / "series.csv").read_text().splitlines()
        return float(rows[-1].split(",")[header.split(",").index("area[m^2]")])

    def test_a_box_becomes_a_sphere(self):
        sphere = 4.0 * math.pi * (3.0 * 8.0 / (4.0 * math.pi)) ** (2.0 / 3.0)
        # Quadratic triangles with edges of a quarter of the radius: 1e-7; a wrong volume would show in the first digit.
        self.assertAlmostEqual(self.area_at_rest(self.imported("box.fe")) / sphere, 1.0, delta=1e-6)

    def test_a_cylinder_becomes_the_catenoid(self):
        for count in (6, 12):  # the curves are followed, whatever polygon the file has
            scene = self.imported(f"catenoid_{count}.fe", catenoid_datafile(count))
            self.assertAlmostEqual(self.area_at_rest(scene) / CATENOID_AREA, 1.0, delta=1e-6)

    def test_kelvins_foam_fills_its_torus(self):
        # 5.3063 per cell of volume 1, twice, each face shared by two cells: docs/equilibrium.md measures it to 1e-4.
        self.assertAlmostEqual(self.area_at_rest(self.imported("kelvin.fe")) / 4.0 ** (2.0 / 3.0), 5.3063, delta=1e-3)

    def test_what_is_exported_comes_back_at_rest(self):
        run = self.folder / "run"
        self.assert_exit(lamella("run", "equilibrium/triple-bubble-small", "--out", run, "--progress", "none"), 0)
        for suffix in ("fe", "obj", "ply"):
            file = self.folder / f"triple.{suffix}"
            self.assert_exit(lamella("export", run, "--to", suffix, "--frame", "last", "--out", file), 0)
            scene = self.folder / f"{suffix}.toml"
            self.assert_exit(lamella("import", file, "--out", scene), 0)
            # The flat triangles hold less than the curved ones of the run: another volume by their error, 1e-2.
            self.assertAlmostEqual(self.area_at_rest(scene) / 13.1281682444334, 1.0, delta=2e-2)

    def test_a_run_needs_nothing_but_its_folder(self):
        scene = self.imported("box.fe")
        run, again = self.folder / "box", self.folder / "again"
        self.area_at_rest(scene)
        expected = results(run)
        (self.folder / "box.fe").unlink()
        self.assertIn('file = "film_1.fe"', (run / "scene.toml").read_text())
        self.assert_exit(lamella("run", run / "scene.toml", "--out", again, "--progress", "none"), 0)
        self.assert_same_results(run, again)
        self.assertEqual((run / "scene.toml").read_bytes(), (again / "scene.toml").read_bytes())
        self.assert_exit(lamella("run", run / "scene.toml", "--out", run, "--overwrite", "--progress", "none"), 0)
        self.assertEqual(results(run), expected)
        self.assert_exit(lamella("resume", run, "--progress", "none"), 0)

    def test_a_scene_names_its_file_from_where_it_is(self):
        (self.folder / "films").mkdir()
        shutil.copy(DATA / "films" / "box.fe", self.folder / "films")
        scene = self.folder / "box.toml"
        self.assert_exit(lamella("import", "films/box.fe", "--out", "box.toml", cwd=self.folder), 0)
        self.assertIn('file = "films/box.fe"', scene.read_text())
        self.assert_exit(lamella("check", scene), 0)
        absolute = lamella("import", "films/box.fe", "--out", "-", cwd=self.folder)
        self.assertIn(f'file = "{self.folder}/films/box.fe"', absolute.stdout)

    def test_malformed_ones_are_refused_in_one_line(self):
        for file in sorted((DATA / "malformed_meshes").iterdir()):
            with self.subTest(file.name):
                head = file.read_bytes().split(b"expect: ")[1].split(b"\n")[0].decode()
                scene = self.folder / "scene.toml"
                self.assert_refused(lamella("import", file, "--out", scene), file.name, head)
                self.assertFalse(scene.exists())

    def test_in_a_scene_are_named_with_the_line_of_their_table(self):
        scene = self.folder / "bad.toml"
        bad = DATA / "malformed_meshes" / "bad_index.fe"
        scene.write_text(f'solver = "equilibrium"\n\n[[film]]\nshape = "mesh"\nfile = "{bad}"\n')
        self.assert_refused(lamella("check", scene), "bad.toml:3", "bad_index.fe:10", "edge 3: there is no vertex 9")
        scene.write_text('solver = "equilibrium"\n\n[[film]]\nshape = "mesh"\n')
        self.assert_refused(lamella("check", scene), "bad.toml:3", "needs file")


if __name__ == "__main__":
    unittest.main()
