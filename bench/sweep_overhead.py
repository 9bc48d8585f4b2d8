# Measures what a point of a sweep costs besides the simulation: time, bytes and files. A stand-in takes the simulator's place.
# SPDX-License-Identifier: Apache-2.0
"""usage: sweep_overhead.py GLINT [POINTS [WORKERS]]

The stand-in copies one finished run, which takes a few milliseconds; the time of it alone is measured too and taken off. Points are checked by the real
program. docs/scale.md has the figures."""
import os
import pathlib
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
    program, count, workers = str(pathlib.Path(sys.argv[1]).resolve()), int((sys.argv + ["", "2000"])[2] or 2000), int((sys.argv + ["", "", "0"])[3] or 0)
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
        measure_tasks(folder, stand_in, alone)
        measure(folder, stand_in, count, workers or len(os.sched_getaffinity(0)), alone)


def measure_tasks(folder, stand_in, alone):
    """Measures tasks as arrays of Slurm run them: a process of Python for each task, which runs its points one after another."""
    from glint.sweeps.execution import Work, to_json
    from glint.sweeps.planning import Program, plan
    program, store, sweep = Program(str(stand_in)), glint.sweeps.Store(folder / "tasks"), glint.sweeps.read(definition(200))
    points, work = plan(sweep, program), Work.of(store, program, sweep)
    for size in (1, 10, 50):
        mine, points = points[:size], points[size:]
        task = folder / f"task{size}.json"
        task.write_text(to_json(work, mine))
        start = time.monotonic()
        subprocess.run([sys.executable, "-S", "-m", "glint.sweeps.worker", task], check=True, env={**os.environ, "PYTHONPATH": str(pathlib.Path(__file__).resolve().parents[1] / "python")}, capture_output=True)
        print(f"a task of {size}: {1000 * ((time.monotonic() - start) / size - alone):.0f} ms a point besides the run")


def measure(folder, stand_in, count, workers, alone):
    from glint.sweeps.planning import Program, plan
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
