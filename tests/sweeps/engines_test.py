# Tests that a sweep on Slurm, on Dask and on Python's executors leaves the bytes of the local pool, also when workers and submitters are killed.
# SPDX-License-Identifier: Apache-2.0
"""usage: engines_test.py GLINT SOURCE_DIR [Slurm|Dask|Executors|Mpi|Parsl|Ray]. All are started for real; where one is not installed, its test skips and says so."""
import concurrent.futures
import contextlib
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import one_node_slurm
from sweeps_case import ROOT, SKIPPED, SweepTest, contents, main, need, points_in

SWEEP = """
name = "thir-ty"
workloads = ["SHIP_SH", "SHIP_AO"]
[run]
size = "16x16"
spp = 1
[[design]]
keys = { rt.warps = [1, 2, 4], core.warps = [8, 12, 16, 24, 32] }
"""
SIXTY = SWEEP.replace("[1, 2, 4]", "[1, 2, 3, 4, 6, 8]")


class EngineTest(SweepTest):
    """Compares stores with that of the local pool, which is filled once."""

    @classmethod
    def setUpClass(cls):
        import glint.sweeps
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.local = pathlib.Path(folder.name)
        (cls.local / "sweep.toml").write_text(SWEEP)
        glint.sweeps.run(cls.local / "sweep.toml", cls.local / "store")

    def setUp(self):
        super().setUp()
        self.write(SWEEP)
        self.store = self.folder / "store"

    def take_sixty_points(self):
        for folder in (self.folder, self.local):
            (folder / "sweep.toml").write_text(SIXTY)
        self.sweeps.run(self.local / "sweep.toml", self.local / "store")

    def some(self, count):
        self.until(lambda: len(points_in(self.store)) >= count)

    def all_are_those_of_the_local_pool(self, count=30):
        found, local = contents(self.store), contents(self.local / "store")
        self.assertEqual(len(found), count)
        self.assertLessEqual(set(found), set(local))
        self.assertEqual([id for id in found if found[id] != local[id]], [])


class Slurm(EngineTest):
    @classmethod
    def setUpClass(cls):
        if reason := one_node_slurm.missing():
            print(f"SKIPPED: engines_test.py Slurm: {reason}")
            sys.stdout.flush()
            os._exit(SKIPPED)
        super().setUpClass()
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        os.chmod(folder.name, 0o755)
        cls.slurm = one_node_slurm.OneNodeSlurm(pathlib.Path(folder.name) / "slurm")
        cls.addClassCleanup(cls.slurm.stop)

    def kill_a_task(self):
        """Kills a process of a task, and returns whether there was one."""
        for pid in self.slurm.tasks():
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
                return True
        return False

    def test_killed_tasks_a_requeued_one_and_a_killed_submitter_lose_nothing(self):
        self.take_sixty_points()
        child = self.start("run", "sweep.toml", "--engine", "slurm", "--store", "store", "--chunk", "3")
        self.some(4)
        child.send_signal(signal.SIGKILL)
        child.wait()
        self.until(self.kill_a_task)
        running = next((line.split("|")[0] for line in self.slurm.jobs() if "RUNNING" in line), None)
        if running:
            subprocess.run(["scontrol", "requeue", running], check=False)  # Slurm would let it wait for two minutes.
            subprocess.run(["scontrol", "update", f"JobId={running}", "StartTime=now"], check=False, stderr=subprocess.DEVNULL)
        self.write(SWEEP.replace('"thir-ty"', '"thir"').replace("[1, 2, 4]", "[1]"), "thir.toml")  # Its name begins the other's.
        self.glint("run", "thir.toml", "--store", "store")
        self.glint("cancel", "thir.toml", "--store", "store")
        status = self.glint("status", "sweep.toml", "--store", "store").stdout
        self.assertIn("60 points", status)
        jobs = {line.split("|")[1] for line in self.slurm.jobs()}
        self.assertTrue(all(name.startswith("glint-thir-ty-") for name in jobs), jobs)
        self.glint("resume", "sweep.toml", "--engine", "slurm", "--store", "store", "--chunk", "3")
        self.all_are_those_of_the_local_pool(60)
        self.assertEqual(self.slurm.tasks(), [])

    def test_detached_tasks_are_found_again_and_can_be_cancelled(self):
        # No task runs before it is released.
        self.glint("run", "sweep.toml", "--engine", "slurm", "--store", "store", "--chunk", "5", "--detach", "--slurm=--hold")
        self.assertEqual(sum("glint-thir-ty" in line for line in self.slurm.jobs()), 6)
        self.assertIn("Slurm has 6 tasks", self.glint("status", "sweep.toml", "--store", "store").stdout)
        self.glint("run", "sweep.toml", "--engine", "slurm", "--store", "store", "--chunk", "5", "--detach")  # submits nothing twice
        self.assertEqual(sum("glint-thir-ty" in line for line in self.slurm.jobs()), 6)
        self.slurm.release_one()
        self.some(1)
        self.glint("cancel", "sweep.toml", "--store", "store")
        self.until(lambda: not any("glint-thir-ty" in line and "COMPLETING" not in line for line in self.slurm.jobs()))
        self.until(lambda: not self.slurm.tasks())
        kept = len(points_in(self.store))
        self.assertLess(kept, 30)
        self.glint("resume", "thir-ty", "--engine", "slurm", "--store", "store")
        self.all_are_those_of_the_local_pool()

    def test_ctrl_c_takes_all_tasks_back(self):
        child = self.start("run", "sweep.toml", "--engine", "slurm", "--store", "store", "--chunk", "3")
        self.some(1)
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.wait(60), 130)
        self.assertEqual(self.slurm.tasks(), [])
        self.assertEqual([line for line in self.slurm.jobs() if "PENDING" in line or "RUNNING" in line], [])
        self.assertEqual(list(self.folder.glob("store/tmp/*")), [])

    def test_the_file_of_the_documentation_runs_here_and_there(self):
        page = (ROOT / "docs/sweeps.md").read_text()
        self.write(re.search(r"cat > warps.toml <<'END'\n(.*?)^END$", page, re.S | re.M)[1], "warps.toml")
        self.assertIn("glint sweep run warps.toml --engine slurm\n", page)
        self.glint("run", "warps.toml", "--store", "here")
        self.glint("run", "warps.toml", "--store", "there", "--engine", "slurm")
        self.assertEqual(len(points_in(self.folder / "here")), 10)
        self.assertEqual(contents(self.folder / "here"), contents(self.folder / "there"))

    def test_what_sbatch_refuses_is_told(self):
        done = self.glint("run", "sweep.toml", "--engine", "slurm", "--store", "store", "--slurm=--partition=nowhere", code=2)
        self.assertIn("sbatch refused", done.stderr)
        self.assertIn("nowhere", done.stderr)


class Dask(EngineTest):
    @classmethod
    def setUpClass(cls):
        need("distributed")
        super().setUpClass()

    def dask(self, name, *words):
        child = subprocess.Popen([sys.executable, "-m", f"distributed.cli.dask_{name}", *map(str, words)], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(lambda: (child.terminate(), child.wait()))
        return child

    def worker(self):
        return self.dask("worker", "--scheduler-file", self.folder / "scheduler.json", "--nthreads", 1, "--no-dashboard", "--local-directory", self.folder)

    def test_killed_workers_and_a_killed_submitter_lose_nothing(self):
        self.take_sixty_points()
        self.dask("scheduler", "--host", "127.0.0.1", "--port", 0, "--no-dashboard", "--scheduler-file", self.folder / "scheduler.json")
        self.until(lambda: (self.folder / "scheduler.json").exists())
        workers = [self.worker() for _ in range(2)]
        import json
        address = json.loads((self.folder / "scheduler.json").read_text())["address"]
        words = ("sweep.toml", "--engine", "dask", "--scheduler", address, "--store", "store", "--chunk", "2")
        child = self.start("run", *words)
        self.some(3)
        workers[0].kill()
        self.some(6)
        child.kill()
        child.wait()
        workers.append(self.worker())
        self.assertLess(len(points_in(self.store)), 60)
        again = self.start("resume", *words)
        self.some(14)
        workers[1].kill()
        self.assertEqual(again.wait(200), 0, again.stdout.read())
        self.all_are_those_of_the_local_pool(60)

    def test_a_cluster_on_this_machine_needs_no_address(self):
        self.glint("run", "sweep.toml", "--engine", "dask", "--workers", 2, "--store", "store")
        self.all_are_those_of_the_local_pool()

    def test_no_scheduler_is_told(self):
        done = self.glint("run", "sweep.toml", "--engine", "dask", "--scheduler", "tcp://127.0.0.1:9", "--store", "store", code=2)
        self.assertIn("no Dask scheduler answers", done.stderr)


class Executors(EngineTest):
    def test_processes_of_python_run_a_sweep_and_may_be_killed(self):
        with concurrent.futures.ProcessPoolExecutor(2) as executor:
            process = executor.submit(os.getpid).result()
            killer = threading.Thread(target=lambda: (self.some(3), os.kill(process, signal.SIGKILL)))
            killer.start()
            found = self.sweeps.run(self.folder / "sweep.toml", self.store, engine=self.sweeps.Engine(executor=executor, chunk=4))
            killer.join()
        self.assertEqual({record["kind"] for record in found.failures}, {"lost"} if found.failures else set())
        self.sweeps.run(self.folder / "sweep.toml", self.store, failed=True)
        self.all_are_those_of_the_local_pool()

    def test_threads_of_python_run_a_sweep(self):
        with concurrent.futures.ThreadPoolExecutor(2) as executor:
            self.sweeps.run(self.folder / "sweep.toml", self.store, engine=self.sweeps.Engine(executor=executor))
        self.all_are_those_of_the_local_pool()


# Open MPI 4 and 5 otherwise refuse more processes than there are cores, and to run as root.
MPI = {"OMPI_MCA_rmaps_base_oversubscribe": "1", "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


class OwnPool(EngineTest):
    """Runs the sweep in a program of its own, because these pools keep their processes until the program ends."""
    MODULE = ""
    PROGRAM = """
import glint.sweeps
{pool}
if __name__ == "__main__":
    with make() as executor:
        found = glint.sweeps.run("sweep.toml", "store", engine=glint.sweeps.Engine(executor=executor, chunk=3))
    print(found.done, "done,", len(found.failures), "failed")
"""

    @classmethod
    def setUpClass(cls):
        need(cls.MODULE)
        super().setUpClass()

    def runs_the_sweep(self, pool, *before):
        """Runs it with the executor that `make` of the lines `pool` gives. `before` is the command in front of the program, in place of Python's."""
        program = self.write(self.PROGRAM.format(pool=pool), "program.py")
        paths = os.pathsep.join(filter(None, (str(ROOT / "python"), os.environ.get("PYTHONPATH"))))
        done = subprocess.run([*(before or [sys.executable]), program], cwd=self.folder, env={**os.environ, **MPI, "PYTHONPATH": paths}, capture_output=True, text=True, timeout=120)
        self.assertIn("30 done, 0 failed", done.stdout, done.stderr)
        self.all_are_those_of_the_local_pool()


class Mpi(OwnPool):
    MODULE = "mpi4py"

    def test_a_pool_that_starts_its_workers_runs_a_sweep(self):
        self.runs_the_sweep("from mpi4py.futures import MPIPoolExecutor\nmake = lambda: MPIPoolExecutor(2)")

    def test_workers_that_mpiexec_has_started_run_a_sweep(self):
        self.runs_the_sweep("from mpi4py.futures import MPIPoolExecutor as make", "mpiexec", "-n", "3", sys.executable, "-m", "mpi4py.futures")


class Parsl(OwnPool):
    MODULE = "parsl"

    def test_a_pool_of_parsl_runs_a_sweep(self):
        self.runs_the_sweep("import parsl\nfrom parsl.concurrent import ParslPoolExecutor\nfrom parsl.configs.htex_local import config\nmake = lambda: ParslPoolExecutor(config)")


class Ray(OwnPool):
    MODULE = "ray"

    def test_the_executor_of_the_documentation_runs_a_sweep(self):
        lines = re.search(r"^class RayExecutor.*?(?=^```)", (ROOT / "docs/sweeps.md").read_text(), re.S | re.M)[0]
        self.runs_the_sweep(f"import concurrent.futures\nimport ray\n{lines}\nmake = RayExecutor")


if __name__ == "__main__":
    main()
