"""Runs that are stopped, killed or run out of disk come out as if nothing had happened."""

import json
import random
import shutil
import signal
import subprocess
import time
import unittest

from program import PROGRAM, ProgramTest, lamella


class Interruption(ProgramTest):
    def setUp(self):
        super().setUp()
        # Long enough to be hit in the middle: a few seconds.
        self.scene.write_text(self.scene.read_text().replace("count = 400", "count = 3000"))
        self.whole = self.folder / "whole"
        begin = time.monotonic()
        self.assert_exit(lamella("run", self.scene, "--out", self.whole), 0)
        self.duration = time.monotonic() - begin

    def start(self, folder):
        return subprocess.Popen([PROGRAM, "run", self.scene, "--out", folder, "--progress", "none"],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def wait_for_frames(self, process, folder, count):
        while len(list((folder / "frames").glob("*.vtp")) if (folder / "frames").exists() else []) < count:
            self.assertIsNone(process.poll(), "the run ended too early")
            time.sleep(0.002)

    def test_by_a_signal_ends_with_a_checkpoint(self):
        for number, name in ((signal.SIGINT, "interrupt"), (signal.SIGTERM, "terminate")):
            folder = self.folder / name
            process = self.start(folder)
            self.wait_for_frames(process, folder, 3)
            process.send_signal(number)
            _, messages = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 128 + number, messages)
            self.assertIn("lamella resume", messages)
            self.assertEqual(json.loads((folder / "run.json").read_text())["state"], "interrupted")
            self.assert_exit(lamella("resume", folder), 0)
            self.assert_same_results(folder, self.whole)

    def test_by_sigkill_at_any_moment(self):
        moments = random.Random(4)
        for attempt in range(6):
            folder = self.folder / f"killed{attempt}"
            process = self.start(folder)
            time.sleep(moments.uniform(0.05, 0.95) * self.duration)
            process.kill()
            process.communicate(timeout=60)
            if not (folder / "scene.toml").exists():
                continue  # it was killed before it had begun
            # Once more while it resumes, then to the end.
            again = subprocess.Popen([PROGRAM, "resume", folder], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(moments.uniform(0.05, 0.5) * self.duration)
            again.kill()
            again.wait(timeout=60)
            self.assert_exit(lamella("resume", folder), 0)
            self.assert_same_results(folder, self.whole)

    def test_by_a_full_disk_leaves_a_folder_that_resumes(self):
        needed = ["unshare", "mount"]
        if any(shutil.which(tool) is None for tool in needed):
            self.skipTest("needs unshare and mount")
        disk = self.folder / "disk"
        disk.mkdir()
        # In a mount namespace of its own the small disk vanishes with the shell; it grows before the run goes on.
        script = f"""
            mount -t tmpfs -o size=1200k lamella-test '{disk}' || exit 99
            '{PROGRAM}' run '{self.scene}' --out '{disk}/run' --progress none; echo "exit $?"
            mount -o remount,size=64m '{disk}'
            '{PROGRAM}' resume '{disk}/run' --progress none; echo "exit $?"
            cp -r '{disk}/run' '{self.folder}/resumed'
        """
        result = subprocess.run(["unshare", "--mount", "sh", "-c", script], capture_output=True, text=True, check=False,
                                timeout=120)
        if result.returncode in (1, 99) and "exit" not in result.stdout:
            self.skipTest(f"no small disk can be mounted here: {result.stderr.strip()}")
        self.assertEqual(result.stdout, "exit 4\nexit 0\n", result.stderr)
        self.assertIn("No space left", result.stderr)
        self.assert_same_results(self.folder / "resumed", self.whole)

    def test_does_not_let_a_second_process_in(self):
        folder = self.folder / "busy"
        process = self.start(folder)
        self.wait_for_frames(process, folder, 1)
        self.assert_refused(lamella("resume", folder), "another lamella process")
        self.assert_refused(lamella("run", self.scene, "--out", folder, "--overwrite"), "another lamella process")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)

    def test_twice_by_ctrl_c_ends_at_once(self):
        self.scene.write_text(self.scene.read_text().replace("count = 3000", "count = 300000"))  # the start is long
        folder = self.folder / "impatient"
        process = self.start(folder)
        while not (folder / "scene.toml").exists():
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20)
        self.assertEqual(process.returncode, 130)


if __name__ == "__main__":
    unittest.main()
