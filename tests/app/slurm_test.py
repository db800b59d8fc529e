"""The job array of a sweep, submitted to a Slurm of one machine that the test brings up in a folder of its own."""

import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from program import PROGRAM, ProgramTest, lamella, results

SKIPPED = 77
TOOLS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo")

FOAM = """
title  = "a small foam"
solver = "bubble"
seed   = 5

[time]
end = {end}
frame_rate = 5.0

[bubble]
count = {count}
end_count = 4
"""

SWEEP = """
scene = "foam.toml"

[axes]
bubble.gas_fraction = {fractions}

[task]
memory = "200M"
wall = "00:10:00"
{more}
"""

CONFIGURATION = """
ClusterName=lamella
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={daemon}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class OneHostSlurm:
    """Its daemons run in the foreground as children of the test, so that they end with it."""

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="lamella-slurm-"))
        self.daemons = []
        self.environment = os.environ | {"SLURM_CONF": str(self.folder / "slurm.conf"), "LAMELLA": PROGRAM}

    def start(self):
        """@returns  why it does not run, or nothing"""
        self.folder.chmod(0o755)
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        host = socket.gethostname().split(".")[0]
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=host, folder=self.folder, controller=free_port(), daemon=free_port()))
        of_munge = {"key-file": "munge.key", "socket": "munge.socket", "pid-file": "munged.pid",
                    "log-file": "munged.log", "seed-file": "munged.seed"}
        self.daemon("munged", "--foreground", "--force", *(f"--{k}={self.folder / v}" for k, v in of_munge.items()))
        if not self.wait_until(lambda: (self.folder / "munge.socket").exists(), 20):
            return "munged does not come up"
        self.daemon("slurmctld", "-D")
        self.daemon("slurmd", "-D", "-N", host)
        if not self.wait_until(lambda: "idle" in self.run("sinfo", "-h", "-o", "%T").stdout, 60):
            return "Slurm does not come up"
        return None

    def daemon(self, *command):
        log = open(self.folder / f"{command[0]}.out", "w", encoding="utf-8")
        self.daemons.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=log))

    def run(self, *command):
        return subprocess.run(list(map(str, command)), env=self.environment, capture_output=True, text=True, check=False,
                              timeout=60)

    def wait_until(self, done, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if done():
                return True
            if any(daemon.poll() is not None for daemon in self.daemons):
                return False
            time.sleep(0.2)
        return False

    def submit(self, folder):
        result = self.run("sbatch", "--parsable", f"--output={folder}/slurm-%a.out", folder / "slurm.sh")
        assert result.returncode == 0, result.stderr
        return result.stdout.strip()

    def queue_is_empty(self):
        result = self.run("squeue", "-h")
        return result.returncode == 0 and not result.stdout.strip()

    def stop(self):
        if len(self.daemons) > 1:
            self.run("scancel", "--user=root")
            self.wait_until(self.queue_is_empty, 20)
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
        shutil.rmtree(self.folder, ignore_errors=True)


class SweepOnSlurm(ProgramTest):
    slurm = None  # set below

    def plan(self, name, count, end, fractions, more):
        (self.folder / "foam.toml").write_text(FOAM.format(count=count, end=end))
        sweep = self.folder / f"{name}.toml"
        sweep.write_text(SWEEP.format(fractions=fractions, more=more))
        out = self.folder / name
        self.assert_exit(lamella("sweep", "plan", sweep, "--out", out), 0)
        return out

    def states(self, out):
        return json.loads(lamella("sweep", "status", out, "--json").stdout)

    def assert_all_done(self, out):
        logs = "\n".join(log.read_text() for log in out.glob("slurm-*.out"))
        states = self.states(out)
        self.assertEqual(len(states["done"]), states["tasks"], logs)

    def assert_same_table(self, a, b):
        tables = [lamella("sweep", "collect", out, "--series", "--out", "-") for out in (a, b)]
        self.assert_exit(tables[0], 0)
        self.assertEqual(tables[0].stdout, tables[1].stdout)

    def test_gives_the_table_of_a_sweep_that_runs_here(self):
        arguments = {"count": 40, "end": 0.4, "fractions": "[0.84, 0.88, 0.9, 0.92, 0.96]", "more": "per_job = 2"}
        here = self.plan("here", **arguments)
        self.assert_exit(lamella("sweep", "run", here), 0)
        there = self.plan("there", **arguments)
        self.slurm.submit(there)
        self.assertTrue(self.slurm.wait_until(self.slurm.queue_is_empty, 120))
        self.assertEqual(len(list(there.glob("slurm-*.out"))), 3, "five tasks, two in a job")
        self.assert_all_done(there)
        self.assert_same_table(here, there)

    def test_goes_on_after_a_job_whose_time_is_up(self):
        arguments = {"count": 2000, "end": 2.0, "fractions": "[0.9]", "more": ""}
        here = self.plan("whole", **arguments)
        self.assert_exit(lamella("sweep", "run", here), 0)
        there = self.plan("requeued", **arguments)
        job = self.slurm.submit(there)
        begun = lambda: any((there / "runs").glob("*/frames/*.vtp"))
        self.assertTrue(self.slurm.wait_until(begun, 60))
        # As --signal=B:TERM@120 does when the end is near.
        self.slurm.run("scancel", "--signal=TERM", "--batch", f"{job}_0")
        pending = lambda: "PENDING" in self.slurm.run("squeue", "-h", "-o", "%T").stdout
        self.assertTrue(self.slurm.wait_until(pending, 60), "it queues again")
        self.assertEqual(self.states(there)["interrupted"], [0])
        # Slurm lets a job that queues again wait for two minutes.
        self.slurm.run("scontrol", "update", f"JobId={job}_0", "StartTime=now")
        self.assertTrue(self.slurm.wait_until(self.slurm.queue_is_empty, 300))
        self.assert_all_done(there)
        self.assert_same_table(here, there)

    def test_runs_one_foam_on_processes_that_srun_starts(self):
        if "mpi" not in json.loads(lamella("version", "--json").stdout)["parts"]:
            self.skipTest("a build without MPI")
        known = self.slurm.run("srun", "--mpi=list")
        if "pmix" not in known.stdout + known.stderr:
            self.skipTest("this Slurm does not speak PMIx")
        scene = self.folder / "foam.toml"
        scene.write_text(FOAM.format(count=300, end=0.4))
        here, there, apart = (self.folder / name for name in ("here", "there", "apart"))
        self.assert_exit(lamella("run", scene, "--out", here, "--progress", "none"), 0)
        run = (PROGRAM, "run", scene, "--progress", "none", "--out")
        self.assert_exit(self.slurm.run("srun", "--mpi=pmix", "--ntasks=2", *run, there), 0)
        self.assertEqual(json.loads((there / "run.json").read_text())["processes"], 2)
        self.assertEqual(results(there), results(here))
        # Processes that do not know of each other would each run the whole foam.
        result = self.slurm.run("srun", "--mpi=none", "--ntasks=2", *run, apart)
        self.assert_exit(result, 2)
        self.assertIn("srun --mpi=pmix", result.stderr)
        self.assertFalse(apart.exists())


if __name__ == "__main__":
    missing = [tool for tool in TOOLS if shutil.which(tool, path=os.environ["PATH"] + ":/usr/sbin") is None]
    if missing or os.geteuid() != 0:
        print("skipped: a Slurm of one machine needs", ", ".join(missing) if missing else "root")
        sys.exit(SKIPPED)
    os.environ["PATH"] += ":/usr/sbin"
    SweepOnSlurm.slurm = OneHostSlurm()
    try:
        why = SweepOnSlurm.slurm.start()
        if why is not None:
            print("skipped:", why)
            sys.exit(SKIPPED)
        unittest.main()
    finally:
        SweepOnSlurm.slurm.stop()
