# Hashes the statistics and the pictures of two small frames, for tests/cli/frames.csv.
# SPDX-License-Identifier: Apache-2.0
"""The hashes are the same on every distribution, with every compiler and at any number of threads."""
import csv
import hashlib
import io
import pathlib
import subprocess
import tempfile

PATH = "tests/cli/frames.csv"
WORKLOADS = ["WKND_PT", "SHIP_SH"]


def measure(glint, workload: str, folder: pathlib.Path, *options: str) -> list[str]:
    """Returns hashes of the statistics (paths and values) and of image.png."""
    subprocess.run([glint, "run", workload, "--config", "mobile", "--size", "64x64", "--spp", "1", *options, "--out", folder], capture_output=True, text=True, check=True)
    values = [f"{row['path']},{row['value']}\n" for row in csv.DictReader((folder / "stats.csv").read_text().splitlines())]
    return [hashlib.sha256(data).hexdigest()[:16] for data in ("".join(values).encode(), (folder / "image.png").read_bytes())]


def table(glint) -> str:
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(["workload", "statistics", "picture"])
    with tempfile.TemporaryDirectory() as folder:
        for workload in WORKLOADS:
            rows.writerow([workload, *measure(glint, workload, pathlib.Path(folder))])
    return out.getvalue()
