"""Sweeps: planned, run by processes that are killed, extended, collected."""

import json
import os
import pathlib
import random
import re
import signal
import socket
import subprocess
import time
import unittest

from program import PROGRAM, ProgramTest, lamella, results

# 40 bubbles for a few steps: a few hundredths of a second.
TINY_FOAM = """
title  = "a tiny foam"
solver = "bubble"
seed   = 5

[time]
end = 0.4
frame_rate = 5.0
series_rate = 10.0

[output]
checkpoint_interval = 0.01

[bubble]
count = 40
end_count = 4
"""

SWEEP = """
scene = "foam.toml"

[axes]
bubble.gas_fraction = { from = 0.85, to = 0.95, step = 0.05 }
"bubble.drag" = ["background", "pairwise"]

[repeat]
seeds = 2
"""


class Sweep(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene.write_text(TINY_FOAM)
        self.sweep = self.folder / "sweep.toml"
        self.sweep.write_text(SWEEP)
        self.out = self.folder / "out"

    def plan(self, text=None):
        if text is not None:
            self.sweep.write_text(text)
        return lamella("sweep", "plan", self.sweep, "--out", self.out)

    def rows(self):
        return [line.split(",") for line in (self.out / "tasks.csv").read_text().splitlines()]

    def table(self, *options):
        result = lamella("sweep", "collect", self.out, "--out", "-", *options)
        self.assert_exit(result, 0)
        return result.stdout

    def states(self):
        return json.loads(lamella("sweep", "status", self.out, "--json").stdout)

    def test_a_plan_is_the_product_of_the_axes(self):
        self.assert_exit(self.plan(), 0)
        rows = self.rows()
        self.assertEqual(rows[0], ["task", "name", "bubble.gas_fraction", "bubble.drag", "seed"])
        self.assertEqual(len(rows), 1 + 3 * 2 * 2)
        self.assertEqual([row[2:] for row in rows[1:4]],
                         [["0.85", '"""background"""', "1"], ["0.85", '"""background"""', "2"], ["0.85", '"""pairwise"""', "1"]])
        self.assertEqual(len({row[1] for row in rows[1:]}), 12)
        self.assertEqual(lamella("sweep", "todo", self.out).stdout.split(), [str(k) for k in range(12)])
        for row in rows[1:]:
            self.assert_exit(lamella("check", self.out / "scenes" / (row[1] + ".toml")), 0)

    def test_a_plan_can_be_extended_and_keeps_what_is_done(self):
        self.assert_exit(self.plan(SWEEP.replace("seeds = 2", "seeds = 1")), 0)
        before = self.rows()
        self.assert_exit(lamella("sweep", "run", self.out, "--task", "3"), 0)
        self.assert_exit(self.plan(SWEEP), 0)
        self.assertEqual(self.rows()[:len(before)], before)
        self.assertEqual(len(self.rows()), 13)
        self.assertEqual(self.states()["done"], [3])
        self.assert_exit(self.plan(SWEEP), 0)  # once more changes nothing
        self.assertEqual(len(self.rows()), 13)

    def test_wrong_input_is_refused_and_nothing_is_written(self):
        for text, words in (
                ("[axes]\nbubble.count = [10]", ["scene is missing"]),
                ('scene = "foam.tml"', ["sweep.toml:1", "foam.tml"]),
                (SWEEP.replace("gas_fraction", "gas_fractoin"), ["gas_fractoin", "did you mean", "task 0"]),
                (SWEEP.replace("0.95", "2.5"), ["gas_fraction", "task"]),
                (SWEEP.replace("step = 0.05", "step = -0.05"), ["sweep.toml:5", "step"]),
                (SWEEP.replace("step = 0.05", "stop = 0.05"), ["sweep.toml:5", "stop"]),
                (SWEEP.replace("step = 0.05", "step = 1e-300"), ["sweep.toml:5", "step"]),
                (SWEEP.replace('["background", "pairwise"]', '"pairwise"'), ["sweep.toml:6", "does not vary"]),
                (SWEEP.replace('["background", "pairwise"]', '["pairwise", "pairwise"]'), ["the same"]),
                (SWEEP.replace("seeds = 2", "seeds = 0"), ["repeat.seeds"]),
                (SWEEP + "[set]\nseed = 3", ["seed is given twice"]),
                (SWEEP + "[[zip]]\ntime.end = [1, 2]\nbubble.count = [10]", ["bubble.count has 1", "time.end has 2"]),
                (SWEEP + "[task]\nthread = 2", ["thread", "did you mean"]),
                (SWEEP.replace("[repeat]", "[repaet]"), ["repaet", "did you mean repeat"]),
        ):
            self.assert_refused(self.plan(text), *words)
            self.assertFalse(self.out.exists(), text)
        for words in (["sweep"], ["sweep", "pln"], ["sweep", "run"], ["sweep", "run", self.folder], ["sweep", "run", "--job", "2"],
                      ["sweep", "collect", self.folder, "--out", "-"]):
            self.assert_refused(lamella(*words))

    def test_a_changed_scene_or_other_axes_need_another_folder(self):
        self.assert_exit(self.plan(), 0)
        self.assert_refused(self.plan(SWEEP.replace("[repeat]\nseeds = 2", "")), "varies", "another folder")
        self.scene.write_text(TINY_FOAM.replace("count = 40", "count = 41"))
        self.assert_refused(self.plan(SWEEP), "changed", "another folder")

    def test_zipped_keys_vary_together(self):
        self.assert_exit(self.plan('scene = "foam.toml"\n[set]\ntime.end = 0.1\n[[zip]]\nbubble.count = [30, 50]\nseed = [7, 8]'), 0)
        self.assertEqual([row[2:] for row in self.rows()], [["bubble.count", "seed"], ["30", "7"], ["50", "8"]])
        self.assertIn("end = 0.1", next((self.out / "scenes").iterdir()).read_text())

    def test_the_table_has_last_rows_rows_at_times_or_all(self):
        self.assert_exit(self.plan(SWEEP.replace("seeds = 2", "seeds = 1")), 0)
        self.assert_exit(lamella("sweep", "run", self.out, "--jobs", "2"), 0)
        last = self.table().splitlines()
        self.assertEqual(len(last), 7)
        self.assertEqual(last[0].split(",")[:4], ["task", "bubble.gas_fraction", "bubble.drag", "seed"])
        name = self.rows()[1][1]
        series = (self.out / "runs" / name / "series.csv").read_text().splitlines()
        self.assertEqual(last[0].split(",")[4:], series[0].split(","))
        self.assertEqual(last[1].split(",")[4:], series[-1].split(","))
        every = self.table("--series").splitlines()
        self.assertEqual([row.split(",", 4)[4] for row in every if row.startswith("0,")], series[1:])
        # Between two rows a column of the table lies where the series has it.
        times = [float(row.split(",")[0]) for row in series[1:]]
        middle = 0.5 * (times[1] + times[2])
        at = self.table("--at", f"{series[0].split(',')[0].split('[')[0]}={middle}").splitlines()
        self.assertEqual(len(at), 7)
        energy = 4 + 1
        expected = 0.5 * (float(series[2].split(",")[1]) + float(series[3].split(",")[1]))
        self.assertAlmostEqual(float(at[1].split(",")[energy]), expected, delta=1e-12 * abs(expected))
        self.assert_refused(lamella("sweep", "collect", self.out, "--out", "-", "--at", "no_column=1"), "no_column")
        self.assert_refused(lamella("sweep", "collect", self.out, "--out", "-", "--at", "x"), "--at")

    def test_a_table_is_drawn(self):
        self.assert_exit(self.plan(), 0)
        self.assert_exit(lamella("sweep", "run", self.out), 0)
        table, picture = self.folder / "table.csv", self.folder / "table.png"
        self.assert_exit(lamella("sweep", "collect", self.out, "--out", table), 0)
        self.assert_exit(lamella("plot", table, "--y", "mean_radius"), 0)
        self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")
        self.assert_refused(lamella("plot", table, "--y", "mean_radios"), "mean_radios", "did you mean mean_radius")
        self.assert_refused(lamella("plot", table), "--y")
        self.assert_refused(lamella("plot", table, "--y", "mean_radius", "--x", "bubble.drag"), "bubble.drag", "not a number")
        self.assert_exit(lamella("sweep", "collect", self.out, "--out", table, "--series"), 0)
        self.assert_exit(lamella("plot", table, "--y", "mean_radius", "--log-x", "--out", self.folder / "curves.svg"), 0)
        self.assertIn("gas_fraction 0.85, drag", (self.folder / "curves.svg").read_text())

    def test_chunks_share_the_tasks(self):
        self.assert_exit(self.plan(), 0)
        self.assert_exit(lamella("sweep", "run", self.out, "--chunk", "1/5"), 0)
        self.assertEqual(self.states()["done"], [1, 6, 11])
        self.assert_refused(lamella("sweep", "run", self.out, "--chunk", "5/5"), "--chunk")
        self.assertIn("#SBATCH --array=0-11", (self.out / "slurm.sh").read_text())
        self.assertEqual(subprocess.run(["bash", "-n", self.out / "slurm.sh"], check=False).returncode, 0)

    def test_a_signal_leaves_a_checkpoint_and_no_lease(self):
        self.scene.write_text(TINY_FOAM.replace("count = 40", "count = 3000").replace("end = 0.4", "end = 40"))
        self.assert_exit(self.plan('scene = "foam.toml"\n[repeat]\nseeds = 2'), 0)
        process = subprocess.Popen([PROGRAM, "sweep", "run", self.out, "--jobs", "2"], stderr=subprocess.PIPE, text=True)
        runs = [self.out / "runs" / row[1] for row in self.rows()[1:]]
        limit = time.monotonic() + 120
        while not all((run / "checkpoint.h5").exists() for run in runs):
            self.assertLess(time.monotonic(), limit)
            time.sleep(0.05)
        self.assertEqual(self.states()["running"], [0, 1])
        process.send_signal(signal.SIGTERM)
        _, messages = process.communicate(timeout=120)
        self.assertIn("2 interrupted", messages)
        self.assertEqual(process.returncode, 128 + signal.SIGTERM, messages)
        self.assertEqual(self.states()["interrupted"], [0, 1])
        self.assertEqual([file.name for file in (self.out / "leases").iterdir() if not file.name.startswith(".")], [])

    def deaths_before(self, process):
        """How many workers died at the task that this one has: after ten it would count as failed."""
        deaths = 0
        for lease in (self.out / "leases").iterdir():
            try:
                words = lease.read_text().split()
            except OSError:
                continue  # just given back
            if len(words) == 4 and words[1] == process:
                deaths = max(deaths, int(words[2]))
        return deaths

    def test_workers_that_are_killed_change_nothing(self):
        many = SWEEP.replace("seeds = 2", f"seeds = {int(os.environ.get('LAMELLA_SWEEP_SEEDS', 4))}")
        self.assert_exit(self.plan(many), 0)
        self.assert_exit(lamella("sweep", "run", self.out, "--jobs", "2", timeout=600), 0)
        expected = self.table("--series")
        names = [row[1] for row in self.rows()[1:]]
        undisturbed = {name: results(self.out / "runs" / name) for name in names}

        self.out = self.folder / "disturbed"
        self.assert_exit(self.plan(many), 0)
        process = subprocess.Popen([PROGRAM, "sweep", "run", self.out, "--jobs", "3", "--progress", "none"],
                                   stderr=subprocess.PIPE, text=True)
        moments, killed = random.Random(3), 0
        while process.poll() is None:
            time.sleep(moments.uniform(0.02, 0.2))
            children = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True, check=False).stdout.split()
            children = [child for child in children if self.deaths_before(child) < 5]
            if children and killed < 2 * len(names):
                try:
                    os.kill(int(moments.choice(children)), signal.SIGKILL)
                    killed += 1
                except ProcessLookupError:
                    pass
        _, messages = process.communicate()
        self.assertEqual(process.returncode, 0, messages)
        self.assertEqual(len(self.states()["done"]), len(names), messages)
        self.assertGreater(killed, 3)
        noticed = int(re.search(r"(\d+) workers were killed", messages).group(1))
        self.assertLessEqual(noticed, killed)  # one may have ended by itself just before
        self.assertGreater(noticed, 0.5 * killed)
        self.assertEqual(self.table("--series"), expected)
        for name in names:
            self.assertEqual(results(self.out / "runs" / name), undisturbed[name])

    def test_a_task_whose_workers_all_died_fails(self):
        self.assert_exit(self.plan('scene = "foam.toml"\n[repeat]\nseeds = 2'), 0)
        lease = self.out / "leases" / self.rows()[1][1]
        gone = subprocess.Popen(["true"])
        gone.wait()
        lease.write_text(f"{socket.gethostname()} {gone.pid} 9 1\n")
        for jobs in (2, 1):
            result = lamella("sweep", "run", self.out, "--jobs", jobs)
            self.assert_exit(result, 3)
            self.assertEqual(self.states()["failed"], [0])
            self.assertEqual(self.states()["done"], [1])

    def test_a_task_that_fails_is_told_and_left(self):
        self.assert_exit(self.plan('scene = "foam.toml"\n[repeat]\nseeds = 2'), 0)
        name = self.rows()[1][1]
        run = self.out / "runs" / name
        self.assert_exit(lamella("sweep", "run", self.out, "--task", "0"), 0)
        for file in run.glob("checkpoint.h5*"):
            file.write_bytes(b"no checkpoint")
        state = json.loads((run / "run.json").read_text())
        state["state"] = "running"
        (run / "run.json").write_text(json.dumps(state))
        result = lamella("sweep", "run", self.out, "--jobs", "1")
        self.assert_exit(result, 3)
        self.assertIn("task 0", result.stderr)
        self.assertEqual(self.states()["done"], [1])


if __name__ == "__main__":
    unittest.main()
