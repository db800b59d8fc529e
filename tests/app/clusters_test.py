"""One run by several processes: the same files as by one, whatever happens to them on the way."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest

from program import PROGRAM, ProgramTest, lamella

SKIPPED = 77
# Gas moves fast, so that bubbles vanish from the first steps on: a run is short, and processes that share cores, as in
# tests, wait for each other at every step.
FOAM = """
title  = "a small foam"
solver = "bubble"
seed   = 5

[time]
end = 0.6
frame_rate = 10.0
series_rate = 50.0

[output]
checkpoint_interval = 0.05

[bubble]
count = 200
end_count = 20
start.max_iterations = 40
gas.exchange_rate = 0.03
"""
WALLED = FOAM.replace("[bubble]", """[bubble]
dimension = 3
gas_fraction = 0.7
walls = [false, true, false]
wall_drag = 0.3
drag = "neighbor_lagged"
flow.kind = "shear"
flow.shear_rate = 0.02""")
# Long enough to be hit in the middle.
LONG_FOAM = FOAM.replace("count = 200", "count = 2000").replace("exchange_rate = 0.03", "exchange_rate = 0.001")


def mpirun(processes, *arguments, **options):
    options.setdefault("timeout", 300)
    command = ["mpirun", "--oversubscribe", "-np", str(processes), PROGRAM, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def processes_of(launcher, folder):
    """Process ids of the program's processes that run in `folder` under this mpirun."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            command = (entry / "cmdline").read_bytes().split(b"\0")
            parent = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
        except OSError:
            continue
        if parent == launcher.pid and command[0].decode() == PROGRAM and str(folder).encode() in command:
            found.append(int(entry.name))
    return found


class Clusters(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene.write_text(FOAM)

    def test_give_the_same_files_on_any_number_of_processes(self):
        walled = self.folder / "walled.toml"
        walled.write_text(WALLED)
        abm2 = ["--set", "bubble.integrator.method=abm2", "--set", "bubble.drag=pairwise", "--until", "0.05"]
        short = ["--until", "0.2"]
        cases = [(self.scene, short, (1, 2, 4)), (walled, short, (3,)), (self.scene, abm2, (2,))]
        for number, (scene, more, numbers) in enumerate(cases):
            alone = self.folder / f"alone{number}"
            self.assert_exit(lamella("run", scene, "--out", alone, *more), 0)
            for processes in numbers:
                folder = self.folder / f"several{number}_{processes}"
                result = mpirun(processes, "run", scene, "--out", folder, *more)
                self.assert_exit(result, 0)
                self.assert_same_results(folder, alone)
                self.assertEqual(json.loads((folder / "run.json").read_text())["processes"], processes)
            self.assertIn(f"processes  {processes}", result.stderr)
            self.assertEqual(result.stderr.count("Done in"), 1)
            session = json.loads((folder / "run.json").read_text())["sessions"][-1]
            self.assertEqual(len(session["exchange_seconds"]), processes)
            self.assertGreater(min(session["exchange_seconds"]), 0.0)

    def test_need_about_the_memory_that_check_says(self):
        for dimension, count in ((2, 40000), (3, 30000)):
            values = {"bubble.dimension": dimension, "bubble.count": count, "bubble.gas_fraction": 0.9,
                      "bubble.start.max_iterations": 5}
            options = [word for key, value in values.items() for word in ("--set", f"{key}={value}")]
            numbers = json.loads(lamella("check", self.scene, "--json", *options).stdout)["characteristic_numbers"]
            said = {name: numbers[name]["value"]
                    for name in ("memory", "processes", "memory_per_process")}
            processes = min(int(said["processes"]), 4)
            for number in (1, processes):
                folder = self.folder / f"memory{dimension}_{number}"
                self.assert_exit(mpirun(number, "run", self.scene, "--out", folder, "--until", "1e-5", *options), 0)
                found = json.loads((folder / "run.json").read_text())["sessions"][-1]["peak_memory_mb"]
                self.assertEqual(len(found), number)
                if number == 1:
                    self.assert_within(said["memory"], found[0])
                elif number == said["processes"]:
                    for process in found:
                        self.assert_within(said["memory_per_process"], process)

    def assert_within(self, said, found, factor=1.3):
        self.assertTrue(found / factor <= said <= found * factor, f"{said} MB planned, {found} MB found")

    def test_continue_each_others_checkpoints(self):
        whole = self.folder / "whole"
        self.assert_exit(lamella("run", self.scene, "--out", whole), 0)
        half = self.folder / "half"
        self.assert_exit(mpirun(2, "run", self.scene, "--out", half, "--until", "0.3"), 0)
        for processes in (1, 3, 4):
            folder = self.folder / f"resumed{processes}"
            shutil.copytree(half, folder)
            result = mpirun(processes, "resume", folder) if processes > 1 else lamella("resume", folder)
            self.assert_exit(result, 0)
            self.assert_same_results(folder, whole)

    def assert_refused_once(self, result, *words):
        self.assert_exit(result, 2)
        own = [line for line in result.stderr.splitlines() if line.startswith("lamella: ")]
        self.assertEqual(len(own), 1, result.stderr)
        for word in words:
            self.assertIn(word, own[0])

    def test_say_once_what_is_wrong(self):
        out = self.folder / "out"
        self.assert_refused_once(mpirun(3, "run", self.folder / "absent.toml", "--out", out), "absent.toml")
        self.assert_refused_once(mpirun(3, "run", self.scene, "--out", out, "--set", "bubble.count=-4"), "count")
        film = mpirun(3, "run", "equilibrium/catenoid-0.4-small", "--out", out)
        self.assert_refused_once(film, "equilibrium", "one process", "3")
        self.assert_refused_once(mpirun(2, "resume", self.folder), "not a run folder")
        self.assertFalse(out.exists())

    def test_take_a_gpu_each_or_say_that_there_are_too_few(self):
        out = self.folder / "out"
        result = mpirun(2, "run", self.scene, "--device", "cuda", "--out", out)
        if result.returncode != 0:
            self.assert_refused_once(result, "--device cpu")
            self.assertFalse(out.exists())
            return
        whole = self.folder / "whole"
        self.assert_exit(lamella("run", self.scene, "--out", whole), 0)
        self.assert_same_results(out, whole)


SWEEP = """
scene = "foam.toml"

[set]
time.end = {end}

[axes]
bubble.gas_fraction = [0.88, 0.92]

[task]
ranks = {ranks}
launcher = "{launcher}"
"""


class SweptClusters(ProgramTest):
    def plan(self, name, ranks, launcher="mpirun --oversubscribe -np {ranks}", scene=FOAM, end=0.1):
        (self.folder / "foam.toml").write_text(scene)
        (self.folder / f"{name}.toml").write_text(SWEEP.format(ranks=ranks, launcher=launcher, end=end))
        out = self.folder / name
        return lamella("sweep", "plan", self.folder / f"{name}.toml", "--out", out), out

    def test_give_the_table_of_runs_of_one_process(self):
        tables = []
        for ranks in (1, 2):
            planned, out = self.plan(f"sweep{ranks}", ranks)
            self.assert_exit(planned, 0)
            self.assertIn(f"--ntasks={ranks}\n", (out / "slurm.sh").read_text())
            self.assert_exit(lamella("sweep", "run", out, "--jobs", "1"), 0)
            tables.append(lamella("sweep", "collect", out, "--series", "--out", "-").stdout)
            for record in out.glob("runs/*/run.json"):
                self.assertEqual(json.loads(record.read_text())["processes"], ranks)
        self.assertIn("gas_fraction", tables[0])
        self.assertEqual(tables[0], tables[1])

    def test_stop_on_a_signal_with_a_checkpoint_and_go_on(self):
        planned, out = self.plan("stopped", 2, scene=LONG_FOAM, end=0.6)
        self.assert_exit(planned, 0)
        worker = subprocess.Popen([PROGRAM, "sweep", "run", out, "--jobs", "1"], stderr=subprocess.DEVNULL)
        while not any(out.glob("runs/*/frames/*1.vtp")):
            self.assertIsNone(worker.poll(), "the sweep ended too early")
            time.sleep(0.01)
        worker.send_signal(signal.SIGTERM)
        self.assertEqual(worker.wait(timeout=60), 128 + signal.SIGTERM)
        states = json.loads(lamella("sweep", "status", out, "--json").stdout)
        self.assertEqual((states["interrupted"], states["waiting"]), ([0], [1]))
        self.assertEqual(len(list(out.glob("runs/*/checkpoint.h5"))), 1)
        self.assert_exit(lamella("sweep", "run", out, "--jobs", "1"), 0)
        self.assertEqual(len(json.loads(lamella("sweep", "status", out, "--json").stdout)["done"]), 2)

    def test_that_cannot_start_are_told(self):
        planned, out = self.plan("nowhere", 2, launcher="no-such-mpirun -np {ranks}")
        self.assert_exit(planned, 0)
        result = lamella("sweep", "run", out, "--jobs", "1")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("no-such-mpirun cannot be started", result.stderr)
        planned, out = self.plan("empty", 2, launcher=" ")
        self.assert_exit(planned, 2)
        self.assertIn("task.launcher", planned.stderr)
        self.assertFalse(out.exists())


class KilledClusters(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene.write_text(LONG_FOAM)

    def test_leave_a_folder_that_resumes_when_one_is_killed(self):
        whole = self.folder / "whole"
        self.assert_exit(lamella("run", self.scene, "--out", whole), 0)
        for victim in (0, -1):
            folder = self.folder / f"killed{victim}"
            launcher = subprocess.Popen(
                ["mpirun", "--oversubscribe", "-np", "3", PROGRAM, "run", self.scene, "--out", folder],
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            while len(list((folder / "frames").glob("*.vtp")) if (folder / "frames").exists() else []) < 3:
                self.assertIsNone(launcher.poll(), "the run ended too early")
                time.sleep(0.01)
            os.kill(sorted(processes_of(launcher, folder))[victim], signal.SIGKILL)
            self.assertNotEqual(launcher.wait(timeout=60), 0)
            self.assert_exit(mpirun(2, "resume", folder), 0)
            self.assert_same_results(folder, whole)

    def test_stop_on_a_signal_to_process_0_with_a_checkpoint(self):
        folder = self.folder / "stopped"
        launcher = subprocess.Popen(
            ["mpirun", "--oversubscribe", "-np", "2", PROGRAM, "run", self.scene, "--out", folder],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while len(list((folder / "frames").glob("*.vtp")) if (folder / "frames").exists() else []) < 2:
            self.assertIsNone(launcher.poll(), "the run ended too early")
            time.sleep(0.01)
        for process in processes_of(launcher, folder):
            os.kill(process, signal.SIGTERM)
        self.assertEqual(launcher.wait(timeout=60), 128 + signal.SIGTERM)
        self.assertEqual(json.loads((folder / "run.json").read_text())["state"], "interrupted")


if __name__ == "__main__":
    version = lamella("version")
    if "mpi" not in version.stdout:
        print("skipped: this build has no MPI")
        sys.exit(SKIPPED)
    if shutil.which("mpirun") is None:
        print("skipped: there is no mpirun")
        sys.exit(SKIPPED)
    os.environ |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    unittest.main()
