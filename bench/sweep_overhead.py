# Measures what a point of a sweep costs besides the simulation: time, bytes and files. A stand-in takes the simulator's place.
# SPDX-License-Identifier: Apache-2.0
"""usage: sweep_overhead.py GLINT [POINTS [WORKERS]] (0 points measure tasks alone)

The stand-in copies one finished run, which takes a few milliseconds; the time of it alone is measured too and taken off. Points are checked by the real
program. docs/scale.md has the figures."""
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import glint.sweeps  # noqa: E402

STAND_IN = """#!/bin/sh
[ "$1" = run ] || exec {glint} "$@"
for word in "$@"; do case "$word" in --out=*) out="${{word#--out=}}" ;; esac; done
exec cp -r {run} "$out"
"""


def definition(points):
    """Returns a sweep of so many different points."""
    side = -(-points // 100)
    return {"name": "overhead", "workloads": ["WKND_SH"], "run": {"size": "8x8", "spp": 1},
            "design": [{"keys": {"core.launch_latency": list(range(1000, 1000 + side)), "core.instruction_budget": list(range(1000000, 1000100))}}]}


def main():
    program, count, workers = str(pathlib.Path(sys.argv[1]).resolve()), int((sys.argv + ["", ""])[2] or 2000), int((sys.argv + ["", "", "0"])[3] or 0)
    with tempfile.TemporaryDirectory(prefix="sweep-overhead-", dir=os.environ.get("GLINT_BENCH_DIR")) as name:
        folder = pathlib.Path(name)
        subprocess.run([program, "run", "WKND_SH", "--size", "8x8", "--spp", "1", "--stats", "compact", "--out", folder / "run"], check=True, capture_output=True)
        stand_in = folder / "stand_in"
        stand_in.write_text(STAND_IN.format(glint=program, run=folder / "run"))
        stand_in.chmod(0o755)
        start = time.monotonic()
        for i in range(100):
            subprocess.run([stand_in, "run", f"--out={folder}/alone{i}"], check=True)
        alone = (time.monotonic() - start) / 100
        measure_tasks(folder, stand_in)
        if count:
            measure(folder, stand_in, count, workers or len(os.sched_getaffinity(0)), alone)


def measure_tasks(folder, stand_in):
    """Measures tasks as arrays of Slurm run them: a process of Python for each task, which runs its points one after another. A stand-in runs alone before each task, and its
    time is taken off, so that both see the same load. The times are medians."""
    from glint.sweeps.execution import Work, to_json
    from glint.sweeps.planning import plan
    from glint.sweeps.program import Program
    program, store, sweep = Program(str(stand_in)), glint.sweeps.Store(folder / "tasks"), glint.sweeps.read(definition(300))
    points, work = plan(sweep, program), Work.of(store, program, sweep)
    environment = {**os.environ, "PYTHONPATH": str(pathlib.Path(__file__).resolve().parents[1] / "python")}
    for size, turns in ((1, 25), (5, 15), (20, 5), (50, 2)):
        walls, processors = [], []
        for turn in range(turns):
            mine, points = points[:size], points[size:]
            task = folder / f"task{size}-{turn}.json"
            task.write_text(to_json(work, mine))
            alone = times_of([stand_in, "run", f"--out={folder}/alone{size}-{turn}"])
            whole = times_of([sys.executable, "-S", "-m", "glint.sweeps.worker", task], environment)
            walls.append(whole[0] / size - alone[0])
            processors.append(whole[1] / size - alone[1])
        print(f"a task of {size}: {1000 * statistics.median(walls):.0f} ms a point besides the run ({1000 * min(walls):.0f} to {1000 * max(walls):.0f} in {turns} tasks), "
              f"{1000 * statistics.median(processors):.0f} ms of a processor")


def times_of(words, environment=None):
    """Runs a command, and returns its seconds on the clock and of a processor, with those of its children."""
    start, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(words, check=True, env=environment, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.monotonic() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(folder, stand_in, count, workers, alone):
    from glint.sweeps.planning import plan
    from glint.sweeps.program import Program
    sweep = definition(count)
    start = time.monotonic()
    points = plan(glint.sweeps.read(sweep), Program(str(stand_in)))
    planned = time.monotonic() - start
    print(f"{len(points)} points, {workers} at a time; the stand-in alone takes {1000 * alone:.1f} ms")
    print(f"checking and naming: {planned:.1f} s, {1000 * planned / len(points):.2f} ms a point")
    start, before = time.monotonic(), time.process_time()
    found = glint.sweeps.run(sweep, folder / "store", engine=glint.sweeps.Engine(workers=workers), glint=stand_in, progress=sys.stderr)
    took, used = time.monotonic() - start, time.process_time() - before
    print(f"running: {took:.1f} s, {1000 * took * workers / len(points) - 1000 * alone:.1f} ms of a worker a point besides the run, of which this process takes {1000 * used / len(points):.1f} ms of a processor; "
          f"{found.done} done, {found.left} left")
    start = time.monotonic()
    glint.sweeps.status("overhead", folder / "store")
    print(f"status: {time.monotonic() - start:.2f} s")
    for turn in ("first", "second"):
        start = time.monotonic()
        collected = glint.sweeps.collect("overhead", folder / "store")
        print(f"collecting, {turn}: {time.monotonic() - start:.2f} s for {len(collected.rows)} rows")
    start = time.monotonic()
    glint.sweeps.run(sweep, folder / "store", glint=stand_in)
    print(f"running again, with nothing to run: {time.monotonic() - start:.1f} s")
    used = {place: [path.stat() for path in (folder / "store" / place).rglob("*")] for place in ("points", "sweeps")}
    for place, files in used.items():
        print(f"{place}: {len(files) / len(points):.2f} files and folders a point, {sum(one.st_size for one in files) / len(points) / 1e3:.1f} kB, {sum(one.st_blocks for one in files) * 512 / len(points) / 1e3:.1f} kB on disk")
    print(f"index: {(folder / 'store/index.sqlite').stat().st_size / len(points) / 1e3:.1f} kB a point")


if __name__ == "__main__":
    main()
