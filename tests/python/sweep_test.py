# Tests sweeps and names of runs: every point has a folder and a name of its own, and only the requested points are returned.
# SPDX-License-Identifier: Apache-2.0
"""usage: sweep_test.py GLINT SOURCE_DIR. The test needs only the standard library; with numpy it also tests its arrays as axes."""
import dataclasses
import importlib.util
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

import python_case
from python_case import GLINT, ROOT, SMALL, PythonTest

TINY = {"size": (8, 8), "spp": 1, "glint": GLINT}


class Number:
    """Stands for one of NumPy's numbers: `item()` returns Python's number."""

    def __init__(self, value):
        self.value = value

    def item(self):
        return self.value


class Sizes(PythonTest):
    def test_a_size_is_a_pair_or_the_text_of_the_command_line(self):
        for i, size in enumerate(((16, 8), "16x8")):
            run = self.glint.run("SHIP_SH", out=self.folder / f"size{i}", size=size, spp=1, mode="functional", glint=GLINT)
            self.assertEqual((run.info["width"], run.info["height"]), (16, 8))


class Sweeps(PythonTest):
    def test_workloads_of_the_same_file_name_have_folders_of_their_own(self):
        files = [ROOT / "examples/spheres/pipeline.toml", ROOT / "examples/hello_triangle/pipeline.toml"]
        lines = []
        for _ in range(2):
            sweep = self.glint.sweep(files, {"core.warps": [8, 16]}, out=self.folder / "stems", progress=lines.append, glint=GLINT)
            self.assertEqual([name.partition("-")[0] for name in sweep], ["spheres_pipeline"] * 2 + ["hello_triangle_pipeline"] * 2)
        self.assertEqual(len(lines), 4)  # nothing was overwritten, so nothing ran again
        self.assertEqual(len({run.info["scene.hash"] for run in sweep.values()}), 2)
        names = self.glint.labels(list(sweep.values()))
        self.assertEqual(len(set(names)), 4, names)

    def test_only_the_points_that_were_asked_for_come_back(self):
        there = self.folder / "used"
        self.glint.sweep("WKND_SH", {"rt.warps": [1, 2]}, out=there, **TINY)
        second = self.glint.sweep("WKND_SH", {"rt.warps": [4]}, out=there, **SMALL)
        for sweep in (second, self.glint.Sweep(there)):
            self.assertEqual([(row["rt.warps"], sweep[row["run"]].info["width"]) for row in sweep.rows(["cycles"])], [(4, 16)])
            self.assertEqual(sweep.others, ["WKND_SH-rt.warps=1", "WKND_SH-rt.warps=2"])
        shutil.rmtree(there / "WKND_SH-rt.warps=4")
        self.assertRegex(self.glint.Sweep(there).failed["WKND_SH-rt.warps=4"], "not been run")

    def test_points_come_in_the_order_of_the_axes_and_once_each(self):
        sweep = self.glint.sweep("WKND_SH", {"rt.warps": [4, 1, 4]}, out=self.folder / "order", **TINY)
        self.assertEqual([row["rt.warps"] for row in sweep.rows(["cycles"])], [4, 1])

    def test_paths_numbers_of_numpy_and_iterators_are_taken(self):
        path = self.folder / "own.toml"
        shutil.copy(ROOT / "examples/mandelbrot/pipeline.toml", path)
        shutil.copy(ROOT / "examples/mandelbrot/mandelbrot.comp", self.folder)
        values = [Number(8), Number(16)]
        if importlib.util.find_spec("numpy"):
            import numpy
            values = numpy.array([8, 16])
        sweep = self.glint.sweep(path, {"core.warps": values}, out=self.folder / "odd", options=iter(["--sample", "500"]), glint=GLINT)
        self.assertEqual([row["core.warps"] for row in sweep.rows(["cycles"])], [8, 16])
        self.assertTrue(all(len(run.series) for run in sweep.values()))  # every point has the options
        self.assertEqual(json.loads((self.folder / "odd/sweep.json").read_text())["axes"], {"core.warps": [8, 16]})

    def test_points_whose_files_or_configuration_changed_are_run_again(self):
        project = self.folder / "project"
        shutil.copytree(ROOT / "examples/mandelbrot", project)
        config = project / "own.toml"
        shutil.copy(ROOT / "configs/mobile.toml", config)
        lines = []

        def cycles(changes):
            sweep = self.glint.sweep(project / "pipeline.toml", {"core.warps": [8]}, config=config, out=self.folder / "again", progress=lines.append, glint=GLINT)
            self.assertEqual(len(lines), changes)
            return next(iter(sweep.values())).cycles

        first = cycles(1)
        (project / "notes.txt").write_text("not read by anybody")
        self.assertEqual(cycles(1), first)
        config.write_text(re.sub(r"launch_latency = \d+", "launch_latency = 20000", config.read_text()))
        self.assertGreater(cycles(2), first)
        shader = project / "mandelbrot.comp"
        shader.write_text(shader.read_text() + "// another text\n")
        cycles(3)
        cycles(3)

    def test_files_that_a_file_names_are_found_through_others(self):
        from glint.fingerprint import files_of
        there = self.folder / "named"
        (there / "sub").mkdir(parents=True)
        for name, text in (("a.toml", 'mesh = "sub/b c.obj"'), ("sub/b c.obj", "mtllib d.mtl\n"), ("sub/d.mtl", "a.toml ../a.toml"), ("e.toml", "")):
            (there / name).write_text(text)
        self.assertEqual([path.name for path in files_of(there / "a.toml")], ["a.toml", "b c.obj", "d.mtl"])
        self.assertEqual(files_of(pathlib.Path("SHIP_SH")), [])

    def test_a_sweep_over_a_key_without_meaning_says_so(self):
        with self.assertWarnsRegex(UserWarning, "memory.dram.simple.latency.*changed nothing"):
            self.glint.sweep("WKND_SH", {"memory.dram.simple.latency": [50.0, 100.0]}, out=self.folder / "idle", set={"memory.dram.model": "banked"}, **TINY)
        self.assertRaisesRegex(TypeError, "leave the key out", self.glint.run, "WKND_SH", out=self.folder / "none", set={"core.warps": None}, **TINY)

    def test_all_points_are_checked_before_the_first_one_runs(self):
        with self.assertRaises(self.glint.CommandFailed) as caught:
            self.glint.sweep("WKND_SH", {"core.warps": [8, 0, 16, 1000]}, out=self.folder / "wrong", **TINY)
        self.assertEqual(caught.exception.code, 2)
        for words in ("2 of 4 points are wrong, so nothing was run", "WKND_SH-core.warps=0", "WKND_SH-core.warps=1000", "expected 1 to"):
            self.assertIn(words, str(caught.exception))
        self.assertFalse((self.folder / "wrong").exists())
        self.assertRaisesRegex(self.glint.GlintError, "a whole number from 0", self.glint.sweep, "WKND_SH", {"core.warps": [8]}, out=self.folder / "wrong", workers=-1, **TINY)

    def stand_in(self, name, lines):
        """Returns a program that does some lines of shell before each run."""
        path = self.folder / f"{name}.sh"
        path.write_text(f'#!/bin/sh\n[ "$1" = run ] || exec {GLINT} "$@"\n{lines}\nexec {GLINT} "$@"\n')
        path.chmod(0o755)
        return path

    def test_the_number_of_workers_changes_no_result(self):
        found = {}
        for workers in (1, 3):
            sweep = self.glint.sweep("WKND_SH", {"rt.warps": [1, 2, 4], "core.warps": [8, 16]}, out=self.folder / f"by{workers}", workers=workers, **TINY)
            found[workers] = [(name, run.cycles, (self.folder / f"by{workers}" / name / "stats.json").read_bytes()) for name, run in sweep.items()]
        self.assertEqual(len(found[1]), 6)
        self.assertEqual(found[1], found[3])

    def test_points_run_at_the_same_time_and_within_their_memory(self):
        # Each run waits until another one has begun, or ends after a while.
        both = self.stand_in("both", f'touch {self.folder}/began.$$; for i in $(seq 100); do [ $(ls {self.folder}/began.* | wc -l) -ge 2 ] && break; sleep 0.1; done; '
                                     f'[ $(ls {self.folder}/began.* | wc -l) -ge 2 ] || exit 9')
        axes = {"rt.warps": [1, 2]}
        self.assertEqual(len(self.glint.sweep("WKND_SH", axes, out=self.folder / "both", workers=2, **{**TINY, "glint": both})), 2)
        alone = self.stand_in("alone", f"mkdir {self.folder}/lock || exit 9; sleep 0.2; rmdir {self.folder}/lock")
        self.assertEqual(len(self.glint.sweep("WKND_SH", axes, out=self.folder / "alone", workers=2, memory=1e-6, **{**TINY, "glint": alone})), 2)

    def test_a_point_that_fails_ends_the_sweep_and_what_is_done_is_kept(self):
        failing = self.stand_in("failing", "case \"$*\" in *rt.warps=2*) echo half; echo 'error: no luck' >&2; exit 3 ;; esac")
        axes = {"rt.warps": [1, 2, 4, 8]}
        with self.assertRaises(self.glint.CommandFailed) as caught:
            self.glint.sweep("WKND_SH", axes, out=self.folder / "failing", workers=1, **{**TINY, "glint": failing})
        self.assertEqual((caught.exception.code, caught.exception.output), (3, "error: no luck\n"))
        self.assertEqual(list(self.glint.Sweep(self.folder / "failing")), ["WKND_SH-rt.warps=1"])
        lines = []
        good = self.stand_in("failing", "")
        self.assertEqual(len(self.glint.sweep("WKND_SH", axes, out=self.folder / "failing", progress=lines.append, **{**TINY, "glint": good})), 4)

    def test_ctrl_c_ends_all_points(self):
        mark = self.folder / "marks"
        mark.mkdir()
        slow = self.stand_in("slow", f"touch {mark}/$$; exec sleep 1000")
        code = "import sys, glint; glint.sweep('WKND_SH', {'rt.warps': [1, 2, 4]}, out=sys.argv[1], workers=2, size=(8, 8), spp=1, glint=sys.argv[2])"
        child = subprocess.Popen([sys.executable, "-c", code, self.folder / "stopped", slow], stderr=subprocess.PIPE, text=True)
        while len(list(mark.iterdir())) < 2:
            time.sleep(0.05)
        child.send_signal(signal.SIGINT)
        self.assertIn("KeyboardInterrupt", child.communicate(timeout=60)[1])
        for one in mark.iterdir():
            self.assertFalse(pathlib.Path("/proc", one.name).exists())
        self.assertEqual(len(list(mark.iterdir())), 2)

    def test_texts_in_the_place_of_lists_are_refused(self):
        self.assertRaisesRegex(TypeError, r"\['--heat'\]", self.glint.run, "WKND_SH", out=self.folder / "text", options="--heat", **TINY)
        self.assertRaisesRegex(TypeError, r"\['gto'\]", self.glint.sweep, "WKND_SH", {"core.issue": "gto"}, out=self.folder / "text", **TINY)
        self.assertRaisesRegex(TypeError, r"\[8\]", self.glint.sweep, "WKND_SH", {"core.warps": 8}, out=self.folder / "text", **TINY)

    def test_a_bench_has_the_workloads_of_its_table_and_names_other_runs(self):
        there = self.folder / "bench"
        for command, out in (("bench", there), ("run", there / "SHIP_SH")):
            workload = "WKND_SH" if command == "bench" else "SHIP_SH"
            subprocess.run([GLINT, command, workload, "--size", "8x8", "--spp", "1", "--out", out], check=True, capture_output=True)
        bench = self.glint.Bench(there)
        self.assertEqual((list(bench), bench.others), (bench.table["workload"], ["SHIP_SH"]))


class Fake:
    """Stands for a run, with what names need of it."""

    def __init__(self, workload="SHIP_SH", config="mobile", directory="out/run", command=(), width=32, samples=1, shader="sh", scene="1", **keys):
        self.workload, self.config_name, self.directory = workload, config, pathlib.Path(directory)
        self.info = {"command": list(command), "width": width, "height": width, "samples": samples, "shader": shader, "scene.hash": scene}
        self.config = {"core.warps": 32, "rt.warps": 4, "memory.l1.size": 65536, **{key.replace("__", "."): value for key, value in keys.items()}}


class Names(PythonTest):
    def named(self, *runs):
        from glint.labelling import named
        return [dataclasses.astuple(one) for one in named(runs)]

    def test_three_keys_that_differ_are_all_in_the_names(self):
        runs = [Fake(core__warps=a, rt__warps=b, memory__l1__size=c) for a in (16, 32) for b in (1, 4) for c in (4096, 65536)]
        found = self.named(*runs)
        self.assertEqual(found[0], ("core.warps=16 · rt.warps=1 · memory.l1.size=4096", "SHIP_SH", "mobile · core.warps=16 · rt.warps=1 · memory.l1.size=4096"))
        for column in (0, 2):
            self.assertEqual(len({one[column] for one in found}), 8)

    def test_no_more_keys_are_shown_than_tell_apart(self):
        found = self.named(*[Fake(core__warps=i, rt__warps=i, memory__l1__size=i) for i in (1, 2)])
        self.assertEqual([one[0] for one in found], ["core.warps=1 · rt.warps=1", "core.warps=2 · rt.warps=2"])

    def test_other_sizes_are_other_tasks(self):
        found = self.named(Fake(width=32), Fake(width=64), Fake(width=64, samples=2))
        self.assertEqual([one[1] for one in found], ["SHIP_SH · 32x32 · 1 spp", "SHIP_SH · 64x64 · 1 spp", "SHIP_SH · 64x64 · 2 spp"])
        self.assertEqual({one[2] for one in found}, {"mobile"})

    def test_a_changed_run_does_not_go_by_the_name_of_its_preset(self):
        found = self.named(Fake(), Fake(rt__warps=1), Fake(config="desktop", rt__warps=8))
        self.assertEqual([one[2] for one in found], ["mobile · rt.warps=4", "mobile · rt.warps=1", "desktop"])
        alone = self.named(Fake(), Fake(config="desktop", rt__warps=1, command=["glint", "run", "SHIP", "--set", "rt.warps=1"]))
        self.assertEqual([one[2] for one in alone], ["mobile", "desktop · rt.warps=1"])  # one run of each preset

    def test_runs_of_everything_the_same_are_told_apart_by_their_folders_or_a_number(self):
        found = self.named(Fake(directory="p/run"), Fake(directory="q/run"))
        self.assertEqual([one[0] for one in found], ["SHIP_SH · p/run", "SHIP_SH · q/run"])
        self.assertEqual([one[2] for one in found], ["mobile", "mobile (2)"])
        self.assertEqual([one[0] for one in self.named(Fake(), Fake())], ["SHIP_SH · run", "SHIP_SH · run (2)"])

    def test_pipelines_of_one_name_are_other_tasks(self):
        self.assertEqual([one[1] for one in self.named(Fake("pipeline", shader="a.rgen a.rmiss", scene="1"), Fake("pipeline", shader="b.rgen", scene="2"))],
                         ["pipeline · a.rgen", "pipeline · b.rgen"])
        self.assertEqual([one[1] for one in self.named(Fake("pipeline", shader="a.rgen", scene="1"), Fake("pipeline", shader="a.rgen", scene="2"))],
                         ["pipeline", "pipeline (2)"])

    def test_a_pipeline_goes_by_a_short_name(self):
        run = self.glint.run(ROOT / "examples/hello_triangle/pipeline.toml", out=self.folder / "pipeline", glint=GLINT)
        self.assertEqual(run.workload, "hello")


class WithoutPackages(PythonTest):
    def test_everything_is_imported_without_matplotlib_and_what_needs_it_names_it(self):
        code = """if True:
            import sys
            sys.modules["matplotlib"] = sys.modules["numpy"] = sys.modules["pandas"] = None
            from glint import *
            assert hasattr(__import__("glint"), "plot") and plot.FIGURES
            try:
                plot.ipc(Run(sys.argv[1]))
            except MissingPackage as error:
                print(error)"""
        done = subprocess.run([sys.executable, "-c", code, self.ship.directory], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("python3-matplotlib", done.stdout)


if __name__ == "__main__":
    python_case.main()
