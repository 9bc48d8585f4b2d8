# Tests that `cmake --install` leaves a Python package that imports, with its table of metrics.
# SPDX-License-Identifier: Apache-2.0
"""usage: install_test.py CMAKE BUILD_DIR"""
import pathlib
import subprocess
import sys
import tempfile

cmake, build = sys.argv[1:3]
with tempfile.TemporaryDirectory() as folder:
    subprocess.run([cmake, "--install", build, "--prefix", folder, "--component", "python"], check=True, capture_output=True)
    package = next(pathlib.Path(folder).glob("lib/python*/dist-packages/glint"), None)
    if package is None:
        sys.exit(f"no lib/python*/dist-packages/glint in {[str(path) for path in pathlib.Path(folder).rglob('*')][:20]}")
    code = "import glint, sys; print(len(glint.metrics()), glint.__file__)"
    done = subprocess.run([sys.executable, "-B", "-c", code], env={"PYTHONPATH": str(package.parent)}, capture_output=True, text=True)
    source = pathlib.Path(__file__).resolve().parents[2] / "python/glint"
    missing = [str(path.relative_to(source)) for path in source.rglob("*") if path.suffix in (".py", ".csv") and not (package / path.relative_to(source)).exists()]
    left = [path.name for path in package.rglob("*") if path.name == "__pycache__"]
    if done.returncode or str(package) not in done.stdout or missing or left:
        sys.exit(f"the installed package does not import: {done.stderr} {done.stdout} missing: {missing} left over: {left}")
    print(done.stdout.strip())
