# Tests sweeps on this machine: their points, what is refused, what is kept, failures, and being killed.
# SPDX-License-Identifier: Apache-2.0
"""usage: local_test.py GLINT SOURCE_DIR [Points|Designs|Keeping|Failures|Killed|Commands]"""
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import time

from sweeps_case import GLINT, ROOT, TINY, SweepTest, contents, main, points_in

GRID = """
workloads = ["WKND_SH"]
store = "store"
constraints = ["rt.warps <= core.warps"]
[run]
size = "8x8"
spp = 1
[[design]]
keys = { rt.warps = [2, 4, 8], core.warps = [4, 8] }
"""


class Points(SweepTest):
    def plan(self, **more):
        from glint.sweeps.planning import plan
        from glint.sweeps.program import Program
        return plan(self.sweeps.read({**TINY, **more}), Program(str(GLINT)))

    def refused(self, words, **more):
        with self.assertRaises(self.sweeps.SweepError) as caught:
            self.plan(**more)
        for word in [words] if isinstance(words, str) else words:
            self.assertIn(word, str(caught.exception))

    def test_workloads_configurations_settings_and_seeds_are_multiplied(self):
        points = self.plan(workloads=["WKND_SH", "SHIP_SH"], configs=["mobile", "desktop"], replicas=3, design=[{"keys": {"rt.warps": [2, 4]}}])
        self.assertEqual(len({point["id"] for point in points}), 2 * 2 * 3 * 2)

    def test_constraints_know_swept_keys_and_all_others(self):
        points = self.plan(constraints=["rt.warps * 2 <= core.warps", "core.warps < 64 or config == 'desktop'"], design=[{"keys": {"rt.warps": [2, 8, 32]}}])
        self.assertEqual([point["set"]["rt.warps"] for point in points], ["2", "8"])  # core.warps is 32 on mobile

    def test_one_wrong_point_refuses_all_and_is_named(self):
        self.refused(["1 of 3 points", "core.warps=0", "WKND_SH on mobile"], design=[{"keys": {"core.warps": [8, 0, 16]}}])
        self.refused(["2 of 2 points", "did you mean"], design=[{"keys": {"core.warp": [8, 16]}}])
        self.refused(["SHIPP_SH", "did you mean 'SHIP'"], workloads=["SHIPP_SH"])
        self.refused("--spp", run={"spp": 0})
        self.refused("did you mean '--bounces'", run={"bounce": 3})
        self.refused("did you mean 'mobile'", configs=["moblie"])

    def test_a_definition_that_is_wrong_says_so(self):
        for words, more in (("'workload'", {"workload": "x"}), ("use `seeds`", {"run": {"seed": 3}}), ("rt.warp", {"constraints": ["rt.warp < 3"]}),
                            ("may have keys", {"constraints": ["open('x')"]}), ("cannot be read", {"constraints": ["rt.warps <"]}), ("no time", {"limits": {"timeout": "soon"}}),
                            ("leave none", {"constraints": ["rt.warps > 1000"]}), ("needs `points`", {"design": [{"method": "random", "keys": {"rt.warps": [2]}}]}),
                            ("stats = \"full\"", {"report": True}), ("seeds", {"seeds": [1], "replicas": 2}), ("folder", {"name": "../x"}),
                            ("without a step", {"design": [{"keys": {"rt.warps": {"low": 1, "high": 2}}}]})):
            with self.subTest(words):
                self.refused(words, **more)

    def test_mistakes_of_a_file_are_told_with_their_lines(self):
        from glint.sweeps.planning import plan
        from glint.sweeps.program import Program
        program = Program(str(GLINT))
        lines = ['workloads = ["WKND_SH"]', 'store = "store"', "[run]", 'size = "8x8"', "spp = 1", "[[design]]", "keys = { rt.warps = [2, 4] }"]
        for line, old, new, words in ((2, "store =", "stroe =", "did you mean 'store'"), (1, "WKND", "WKNT", "did you mean 'WKND'"), (1, '["WKND_SH"]', "[1]", "a list of texts"),
                                      (1, '["WKND_SH"]', '["WKND_SH", "WKND_SH"]', "twice"), (5, "spp = 1", "spq = 1", "did you mean '--spp'"), (5, "spp = 1", "spp = 0", "65536"), (4, "8x8", "8by8", "WIDTHxHEIGHT"),
                                      (7, "[2, 4]", "[2, 0]", "expected 1 to 64"), (7, "rt.warps", "rt.warpz", "unknown key"), (7, "[2, 4]", "[2, 2]", "twice"), (7, "[2, 4]", '["two"]', "is a string"),
                                      (6, "[2, 4]", "{ low = 1, high = 1000000000, step = 1 }", "1,000,000,000 points"), (7, "keys", 'method = "gird"\nkeys', "one of grid"),
                                      (8, "keys = {", "[set]\nrt.warps = 4\n[[design]]\nkeys = {", "remove one"), (2, "store =", 'constraints = ["rt.warps > 99"]\nstore =', "leave none"),
                                      (2, "store =", 'constraints = ["rt.warps >< 9"]\nstore =', "invalid syntax"), (2, "store =", 'constraints = ["rt.warpz > 9"]\nstore =', "is no key"),
                                      (2, "store =", 'objectives = ["cyclez"]\nstore =', "did you mean 'cycles'"), (2, "store =", "name = 3\nstore =", "a folder's"), (3, "[run]", "[run", "no TOML"),
                                      (6, "spp = 1", "spp = 1\nspp = 2", "no TOML")):
            with self.subTest(new):
                text = "\n".join(lines)
                self.assertIn(old, text)
                with self.assertRaises(self.sweeps.SweepError) as caught:
                    plan(self.sweeps.read(self.write(text.replace(old, new))), program)
                self.assertIn(f"sweep.toml:{line}: ", str(caught.exception))
                self.assertIn(words, str(caught.exception))

    def test_a_point_is_named_by_what_it_depends_on(self):
        default = self.plan()[0]["id"]
        self.assertEqual(self.plan(design=[{"keys": {"rt.warps": [4]}}])[0]["id"], default)  # the preset's own value
        self.assertNotEqual(self.plan(run={"size": "8x8", "spp": 2})[0]["id"], default)
        self.assertNotEqual(self.plan(seeds=[2])[0]["id"], default)
        self.assertNotEqual(self.plan(configs=["desktop"])[0]["id"], default)
        source = ROOT / "examples/mandelbrot"
        for name in ("pipeline.toml", "mandelbrot.comp"):
            (self.folder / name).write_bytes((source / name).read_bytes())
        one = self.plan(workloads=[str(self.folder / "pipeline.toml")], run={})[0]["id"]
        (self.folder / "mandelbrot.comp").write_text((source / "mandelbrot.comp").read_text() + "// changed\n")
        self.assertNotEqual(self.plan(workloads=[str(self.folder / "pipeline.toml")], run={})[0]["id"], one)


class Designs(SweepTest):
    def test_samples_are_the_same_each_time_and_lie_in_their_ranges(self):
        from glint.sweeps.design import points_of
        keys = {"a": {"low": 1, "high": 8}, "b": {"low": 0.5, "high": 2.0, "scale": "log"}, "c": ["x", "y"], "d": {"low": 2, "high": 64, "scale": "power2"}}
        for method in ("random", "latin-hypercube"):
            points = points_of(method, keys, 64, 7, [])
            self.assertEqual(points, points_of(method, keys, 64, 7, []))
            self.assertNotEqual(points, points_of(method, keys, 64, 8, []))
            self.assertEqual({point["a"] for point in points}, set(range(1, 9)))
            self.assertTrue(all(0.5 <= point["b"] <= 2 for point in points))
            self.assertEqual({point["d"] for point in points}, {2, 4, 8, 16, 32, 64})

    def test_a_latin_hypercube_has_each_slice_once(self):
        from glint.sweeps.design import points_of
        points = points_of("latin-hypercube", {"a": {"low": 0.0, "high": 10.0}, "b": {"low": 0.0, "high": 1.0}}, 10, 1, [])
        self.assertEqual(sorted(int(point["a"]) for point in points), list(range(10)))
        self.assertEqual(sorted(int(point["b"] * 10) for point in points), list(range(10)))

    def test_grids_lists_and_steps_are_what_they_say(self):
        from glint.sweeps.design import points_of
        self.assertEqual(points_of("grid", {"a": {"low": 2, "high": 8, "step": 3}, "b": [True]}, None, 1, []), [{"a": 2, "b": True}, {"a": 5, "b": True}, {"a": 8, "b": True}])
        self.assertEqual(points_of("list", {}, None, 1, [{"a": 1}, {"b": 2}]), [{"a": 1}, {"b": 2}])


class Keeping(SweepTest):
    def test_what_exists_is_never_run_again_in_this_sweep_or_another(self):
        runs = self.folder / "runs"
        program = self.stand_in(f'echo "$@" >> {runs}')
        first = self.sweeps.run({**TINY, "design": [{"keys": {"rt.warps": [2, 4]}}]}, self.folder / "store", glint=program)
        self.assertEqual((first.done, first.left), (2, 0))
        other = {**TINY, "name": "other", "design": [{"keys": {"rt.warps": [2, 4, 8]}}]}
        self.assertEqual(self.sweeps.run(other, self.folder / "store", glint=program).done, 3)
        self.sweeps.run(other, self.folder / "store", glint=program)
        self.assertEqual(len(runs.read_text().splitlines()), 3)

    def test_two_sweeps_at_once_share_a_store_and_run_each_point_once(self):
        runs = self.folder / "runs"
        program = self.stand_in(f'echo "$@" >> {runs}; sleep 0.05')
        self.write(GRID.replace("[2, 4, 8]", str(list(range(1, 9)))))
        os.environ["GLINT"] = str(program)
        self.addCleanup(os.environ.__setitem__, "GLINT", str(GLINT))
        code = "import sys, glint.sweeps as s; sys.exit(s.run('sweep.toml', engine=s.Engine(workers=3)).left)"
        both = [subprocess.Popen([sys.executable, "-c", code], cwd=self.folder) for _ in range(2)]
        self.assertEqual([child.wait() for child in both], [0, 0])
        self.assertEqual(len(points_in(self.folder / "store")), 12)
        self.assertEqual(len(runs.read_text().splitlines()), 12)

    def test_a_lock_ends_with_its_process_however_it_ends(self):
        store = self.sweeps.Store(self.folder / "store")
        id = "0123456789abcdef" * 2
        code = f"import glint.sweeps as s, time; print(s.Store({str(store.folder)!r}).lock({id!r}), flush=True); time.sleep(100)"
        child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "True\n")
        self.assertFalse(store.lock(id))
        self.assertTrue(store.lock("f" + id[1:]))
        child.kill()
        child.wait()
        child.stdout.close()
        self.assertTrue(store.lock(id))
        other = self.sweeps.Store(store.folder)  # of the same process
        self.assertFalse(other.lock(id))
        other.close()
        self.assertFalse(self.sweeps.Store(store.folder).lock(id))

    def test_a_point_that_comes_second_leaves_the_first(self):
        store = self.sweeps.Store(self.folder / "store")
        id = "ab" * 16
        store.commit(id, {}, {"n": 1})
        store.commit(id, {}, {"n": 2})
        self.assertEqual(store.read(id), {"n": 1})
        self.assertEqual(list((store.folder / "tmp").iterdir()), [])

    def test_a_damaged_point_is_told_removed_and_run_again(self):
        definition = {**TINY, "design": [{"keys": {"rt.warps": [2, 4, 8]}}]}
        program, folder = self.stand_in(), self.folder / "store"
        self.sweeps.run(definition, folder, glint=program)
        first, second, third = points_in(folder)
        store = self.sweeps.Store(folder)
        (store.point(first) / "point.json").write_text("{")
        with open(store.point(second) / "run.zip", "r+b") as file:
            file.write(b"damage")
        self.assertEqual(self.sweeps.collect("sweep", folder).damaged, [first])
        self.assertIn("2 points with damaged files", self.glint("gc", "--store", folder, "--yes").stdout)
        self.assertEqual(points_in(folder), [third])
        self.assertEqual(self.sweeps.run(definition, folder, glint=program).done, 3)

    def test_variables_that_change_results_are_those_of_the_plan_and_name_points(self):
        from glint.sweeps.execution import Work
        from glint.sweeps.planning import plan
        from glint.sweeps.program import Program
        program, definition = self.stand_in('[ "$GLINT_ASSETS" = "%s" ] || exit 1' % self.folder), self.sweeps.read({**TINY, "retry": {"crash": 0}})
        bare = plan(definition, Program(str(program)))[0]["id"]
        os.environ["GLINT_ASSETS"] = str(self.folder)
        point, store = plan(definition, Program(str(program)))[0], self.sweeps.Store(self.folder / "store")
        work = Work.of(store, Program(str(program)), definition)
        os.environ["GLINT_ASSETS"] = "/elsewhere"
        self.addCleanup(os.environ.pop, "GLINT_ASSETS", None)
        self.assertNotEqual(point["id"], bare)
        self.assertEqual(work.run(point, store)["status"], "done")

    def test_a_folder_that_is_no_store_is_refused(self):
        (self.folder / "mine.txt").write_text("x")
        self.assertRaisesRegex(self.sweeps.SweepError, "no store", self.sweeps.Store, self.folder)

    def test_a_program_that_changed_meanwhile_runs_nothing(self):
        from glint.sweeps.execution import Work
        from glint.sweeps.program import Program
        program = self.stand_in()
        work = Work.of(self.sweeps.Store(self.folder / "store"), Program(str(program)), self.sweeps.read(TINY))
        work.check_program()
        program.write_text(program.read_text() + "# another\n")
        self.assertRaisesRegex(self.sweeps.SweepError, "has changed", work.check_program)


class Failures(SweepTest):
    def outcome(self, before, **more):
        count = self.folder / "count"
        count.unlink(missing_ok=True)
        program = self.stand_in(f'echo x >> {count}; case "$*" in *rt.warps=2*) {before} ;; esac')
        found = self.sweeps.run({**TINY, "design": [{"keys": {"rt.warps": [2, 4, 8]}}], **more}, self.folder / f"store{len(list(self.folder.iterdir()))}", glint=program)
        self.assertEqual((found.done, len(found.failures)), (2, 1))
        return found.failures[0], len(count.read_text().splitlines()) - 2

    def test_a_point_that_fails_is_retried_by_policy_recorded_and_stops_no_other(self):
        crash, tries = self.outcome("echo 'boom error here'; kill -SEGV $$")
        self.assertEqual((crash["kind"], tries, crash["log"].strip()), ("crash", 2, "boom error here"))
        timeout, tries = self.outcome("exec sleep 100", limits={"timeout": "0.5 s"})
        self.assertEqual((timeout["kind"], tries), ("timeout", 1))
        memory, tries = self.outcome("echo 'error: out of memory'; exit 1", retry={"memory": 2})
        self.assertEqual((memory["kind"], tries), ("memory", 3))
        refused, tries = self.outcome("echo 'error: no' >&2; exit 2")
        self.assertEqual((refused["kind"], tries, refused["message"]), ("refused", 1, "error: no"))

    def test_a_real_run_without_memory_is_told_as_one(self):
        found = self.sweeps.run({**TINY, "limits": {"memory": "60 MB"}}, self.folder / "store")
        self.assertEqual([record["kind"] for record in found.failures], ["memory"], found.failures)

    def test_failures_run_again_only_when_asked(self):
        definition, good = {**TINY, "retry": {"crash": 0}}, self.folder / "good"
        program = self.stand_in(f"[ -e {good} ] || exit 1")
        self.assertEqual(len(self.sweeps.run(definition, self.folder / "store", glint=program).failures), 1)
        good.touch()
        self.assertEqual(len(self.sweeps.run(definition, self.folder / "store", glint=program).failures), 1)
        self.assertEqual(self.sweeps.run(definition, self.folder / "store", glint=program, failed=True).done, 1)


class Killed(SweepTest):
    def test_nothing_is_lost_by_being_killed_at_50_random_moments(self):
        self.write(GRID.replace("[2, 4, 8]", str(list(range(1, 25)))).replace("[4, 8]", "[24, 32]"))
        program = self.stand_in("sleep 0.2")
        code = "import sys, glint.sweeps as s; print('ready', flush=True); sys.exit(s.run('sweep.toml', engine=s.Engine(workers=2), glint=sys.argv[1]).left)"
        source, kept, longest, early = random.Random(23), set(), 0.2, 0
        for _ in range(50):
            child = subprocess.Popen([sys.executable, "-c", code, program], cwd=self.folder, stdout=subprocess.PIPE)
            child.stdout.readline()  # Before this line there is nothing to lose.
            time.sleep(source.uniform(0, longest))
            child.kill()
            child.stdout.close()
            child.wait()
            now = set(points_in(self.folder / "store"))
            self.assertLessEqual(kept, now)
            kept = now
            early += len(kept) < 48
            longest *= 1 if kept else 1.2  # A slow machine gets the time to end a point.
            for path in (self.folder / "store").glob("points/*/*"):
                self.assertEqual(sorted(one.name for one in path.iterdir()), ["point.json", "run.zip"])
                json.loads((path / "point.json").read_text())
        self.assertGreater(len(kept), 0)
        subprocess.run([sys.executable, "-c", code, program], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
        self.assertEqual(len(points_in(self.folder / "store")), 48)
        self.assertEqual(len(contents(self.folder / "store")), 48)
        print(f"{len(kept)} of 48 points were complete after the kills, of which {early} came before the last point was")
        self.glint("gc", "--store", "store", "--yes")
        self.assertEqual(list((self.folder / "store/tmp").iterdir()), [])

    def test_a_run_ends_with_the_process_that_started_it(self):
        mark = self.folder / "pid"
        program = self.stand_in(f"echo $$ > {mark}; exec sleep 1000")
        code = "import sys, glint.sweeps as s; s.run('sweep.toml', glint=sys.argv[1])"
        self.write('workloads = ["WKND_SH"]\n')
        child = subprocess.Popen([sys.executable, "-c", code, program], cwd=self.folder)
        self.until(lambda: mark.exists() and mark.read_text().strip())
        child.kill()
        child.wait()
        about = pathlib.Path("/proc", mark.read_text().strip(), "stat")
        self.until(lambda: not about.exists() or about.read_text().split()[2] == "Z")


class Commands(SweepTest):
    def test_a_sweep_runs_says_how_far_it_is_and_gives_its_points(self):
        self.write(GRID)
        said = self.glint("run", "sweep.toml").stdout
        self.assertIn("sweep: 5 points, 5 different: 5 done, 0 failed, 0 left", said)
        self.assertEqual(self.glint("status", "sweep", "--store", "store").stdout, said)
        self.assertEqual(json.loads(self.glint("status", "sweep.toml", "--json").stdout)["done"], 5)
        id = points_in(self.folder / "store")[0]
        self.glint("open", "sweep.toml", "--point", id[:12], "--out", "opened")
        import glint
        self.assertGreater(glint.Run(self.folder / "opened").cycles, 0)
        self.assertIn("5 points, 5 different, all of them right", self.glint("run", "sweep.toml", "--dry-run").stdout)

    def test_ctrl_c_and_cancel_leave_everything_tidy(self):
        # No frame of this size ends before it is stopped, however fast the machine is.
        self.write(GRID.replace("8x8", "2048x2048").replace("spp = 1", "spp = 256"))
        scratch = self.folder / "scratch"
        scratch.mkdir()
        for stop, code in ((lambda child: child.send_signal(signal.SIGINT), 130), (lambda child: self.glint("cancel", "sweep.toml"), 1)):
            child = self.start("run", "sweep.toml", TMPDIR=str(scratch))
            self.until(lambda: any(scratch.glob("*/log.txt")))
            stop(child)
            self.assertEqual(child.wait(60), code, child.stdout.read())
            self.assertEqual([*self.folder.glob("store/tmp/*"), *self.folder.glob("store/sweeps/sweep/runs/*"), *scratch.iterdir()], [])

    def test_mistakes_are_named(self):
        self.write("workloads = [", "broken.toml")
        for words, text in ((("run",), "needs the sweep"), (("run", "no.toml"), "no such file"), (("run", "broken.toml"), "broken.toml"), (("status", "nosuch", "--store", "store"), "no store")):
            self.assertIn(text, self.glint(*words, code=2).stderr)
        self.assertFalse((self.folder / "store").exists())
        self.sweeps.Store(self.folder / "store").close()
        self.assertIn("no sweep 'nosuch'", self.glint("status", "nosuch", "--store", "store", code=2).stderr)

    def test_the_command_and_the_package_have_the_same_options(self):
        from glint.sweeps.command import parser
        told = subprocess.run([GLINT, "sweep", "--help"], capture_output=True, text=True, check=True).stdout
        mine = {option for action in parser()._actions for option in action.option_strings if option.startswith("--")}
        self.assertEqual(set(re.findall(r"^  (?:-h,)?(--[a-z-]+)", told, re.M)), mine)
        actions = next(action for action in parser()._actions if action.dest == "action").choices
        self.assertEqual(re.search(r"ACTION TEXT:\{([^}]*)\}", told)[1].split(","), list(actions))


if __name__ == "__main__":
    main()
