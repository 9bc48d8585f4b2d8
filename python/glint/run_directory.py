# Reads one finished run: each file of its directory is read when it is asked for.
# SPDX-License-Identifier: Apache-2.0
"""`Run(directory)` has the statistics, metrics, configuration, picture, time series, profile and maps of a run."""
from __future__ import annotations

import dataclasses
import functools
import pathlib
import tomllib
import warnings
from typing import TYPE_CHECKING, Any

from .documents import flat, read_json, read_text
from .errors import IncompleteRun, MissingFile, SchemaError, UnknownName
from .file_list import ListedFiles
from .images import read_image, read_map
from .derived import Metrics
from .patterns import near
from .statistics import Stats
from .table import Table

if TYPE_CHECKING:
    from .trace import Trace

SCHEMA = 1  # of run.json, as report/files/run_directory.cpp writes it
SHADERS = ("pt", "sh", "ao")  # shaders of scenes; pipelines and kernels list their own files
_SAMPLE = "gpu.sample."  # path of the estimates of a sampled run
_LAST_TABLE = "compiler"  # of config.toml; a file without it was cut short


@dataclasses.dataclass(frozen=True)
class Estimate:
    """Holds an estimate of a sampled run with its 95 % interval."""
    value: float
    low: float
    high: float


class Facts(dict[str, Any]):
    """Holds values by dotted name ("scene.triangles"). A missing name raises UnknownName, which lists similar names."""

    def __missing__(self, name: str) -> Any:
        raise UnknownName(f"there is no '{name}'{near(name, self)}")


class Run:
    """Holds a run directory of `glint run` or of one workload of `glint bench`.

    Args:
        directory: The folder.
        partial: Whether to accept runs that ended with an error. Such a run may have no statistics.

    Raises:
        MissingFile: There is no run.json (this is no run directory, or the run was killed) or no stats.json.
        IncompleteRun: The run ended with an error, which the message repeats.
        SchemaError: A file has another schema or is damaged.

    Each file is compared with its length and sum in run.json when it is first asked for.
    """

    def __init__(self, directory: str | pathlib.Path, partial: bool = False):
        self.directory = pathlib.Path(directory)
        record = self.directory / "run.json"
        if not self.directory.is_dir():
            raise MissingFile(f"{self.directory}: there is no such folder")
        if not record.is_file():
            raise MissingFile(f"{self.directory}: there is no run.json: this is no run directory, or the run was stopped before its end")
        tree = read_json(record)
        if tree.get("schema") != SCHEMA:
            raise SchemaError(f"{record}: the schema is {tree.get('schema')!r}, but this package reads {SCHEMA}: use the package of the Glint that wrote the run")
        self._files = ListedFiles(self.directory, "run.json", tree.pop("files", None), "run it again")
        self.info = Facts(flat(tree))
        if not partial and self.info.get("exit", 0) != 0:
            raise IncompleteRun(f"{self.directory}: the run ended with exit code {self.info['exit']}: {self.info.get('message', '')}")
        if not partial:
            if "mode" not in self.info:
                raise SchemaError(f"{record}: there is no 'mode': the file is damaged")
            self.file(self._stats_file, "every run that ends well")
            if not self._files.is_known:
                warnings.warn("an earlier version of Glint wrote the run without the lengths and sums of its files, so damage to them cannot be noticed", stacklevel=2)

    def __repr__(self) -> str:
        return f"Run('{self.directory}': {self.workload}, {self.info['mode']} on {self.config_name})"

    def check(self) -> None:
        """Reads statistics and configuration. Raises MissingFile or SchemaError when one is missing or damaged."""
        self.stats, self.config  # noqa: B018 (kept once they are read)

    @property
    def workload(self) -> str:
        """Returns scene and shader, such as "SHIP_SH". For pipelines and kernels it is the file's name, and for a pipeline.toml that of its first shader."""
        scene, shader = str(self.info.get("scene.name", "")), str(self.info.get("shader", ""))
        if shader in SHADERS:
            return f"{scene}_{shader.upper()}"
        return pathlib.PurePath(shader.split()[0]).stem if scene == "pipeline" and shader.split() else scene or self.directory.name

    @property
    def config_name(self) -> str:
        """Returns the name of the preset or configuration file."""
        return str(self.info.get("config.name", ""))

    @property
    def _stats_file(self) -> str:
        return "stats.csv" if self.info.get("statistics") == "compact" else "stats.json"

    @functools.cached_property
    def stats(self) -> Stats:
        """Returns all statistics by dotted path. A run with `--stats compact` has totals alone: "gpu.core[*].instructions"."""
        path = self.file(self._stats_file, "every run that ends well")
        try:
            if path.suffix == ".csv":
                return Stats.from_totals(Table.read(path, needs=("path", "value", "unit"), whole=True))
            return Stats.from_tree(read_json(path))
        except SchemaError as error:
            raise SchemaError(str(error) if str(path) in str(error) else f"{path}: {error}") from error

    @functools.cached_property
    def metrics(self) -> Metrics:
        """Returns the metrics of docs/metrics.md by name. A metric that the run does not have is None."""
        return Metrics(self)

    @functools.cached_property
    def config(self) -> Facts:
        """Returns every configuration key by dotted name, with its value in the run."""
        path = self.file("config.toml", "every run")
        try:
            tree = tomllib.loads(read_text(path))
        except tomllib.TOMLDecodeError as error:
            raise SchemaError(f"{path}: {error}") from error
        if _LAST_TABLE not in tree:
            raise SchemaError(f"{path}: there is no [{_LAST_TABLE}], the last table of a whole file: it was cut short")
        return Facts(flat(tree))

    @property
    def is_sampled(self) -> bool:
        """Returns whether only a sample of the launch was run (docs/sampling.md)."""
        return "sample.share" in self.info

    @functools.cached_property
    def estimates(self) -> dict[str, Estimate]:
        """Returns what a sampled run estimates of its whole launch, by name; nothing for a whole run."""
        names = [path for path in self.stats if path.startswith(_SAMPLE) and f"{path}_low" in self.stats]
        return {path[len(_SAMPLE):]: Estimate(*(self.stats[path + end] for end in ("", "_low", "_high"))) for path in names}

    @property
    def cycles(self) -> int:
        """Returns the time of the launch in core clocks, which a sampled run estimates. Raises UnknownName for a functional run, which has none."""
        if self.is_sampled:
            return round(self.estimates["cycles"].value)
        if self.info["mode"] != "timing":
            raise UnknownName(f"{self.directory}: a functional run has no cycles: run it with --mode timing")
        return self.stats["gpu.cycles"]

    @property
    def seconds(self) -> float:
        """Returns the time of the launch on the simulated GPU, in seconds."""
        return self.cycles / (self.config["clock_mhz"] * 1e6)

    @property
    def ipc(self) -> float:
        """Returns warp instructions per cycle of the whole GPU, as `glint run` prints it. The metric `thread_ipc` counts lanes."""
        if self.is_sampled:
            return self.estimates["ipc"].value
        return self.stats.sum("gpu.core[*].instructions") / self.cycles if self.cycles else 0.0

    @functools.cached_property
    def image(self) -> Any:
        """Returns the picture as the shader wrote it: a float32 array of the shape (height, width, 3)."""
        return read_image(self.file("image.pfm", "runs of scenes"))

    @functools.cached_property
    def series(self) -> Table:
        """Returns the run over time, with a row per interval (docs/profiling.md)."""
        path = self.file("series.csv", "`glint run --sample CYCLES`")
        table = Table.read(path, needs=("cycle", "ipc"), whole=True)
        ends, whole = table["cycle"][-1] if len(table) else 0, self.directory / self._stats_file
        last = max([self.cycles, *self.stats.values("gpu.attributed_cycles")]) if whole.is_file() else 0
        if not isinstance(ends, (int, float)) or ends < last:
            raise SchemaError(f"{path}: the series ends at cycle {ends} and the run at {last}: the file is damaged or was cut short")
        return table

    @functools.cached_property
    def trace(self) -> Trace:
        """Returns what warps and RT units did cycle by cycle. The run needs `--trace`."""
        from .trace import Trace  # noqa: F811 (few runs have one)
        return Trace(self.file("trace.json.gz", "--trace"))

    @functools.cached_property
    def profile(self) -> Table:
        """Returns cycles by instruction and by source line (docs/profiling.md)."""
        return Table.read(self.file("profile.csv", "`glint run --profile`"), needs=("by", "stage", "line", "op", "issues", "cycles"), whole=True)

    @functools.cached_property
    def folded(self) -> dict[str, int]:
        """Returns cycles by call stack. Frames are separated by ';', which is the input format of flame graphs."""
        path, stacks = self.file("profile.folded", "`glint run --profile`"), {}
        for number, line in enumerate(read_text(path).splitlines(), 1):
            stack, _, cycles = line.rpartition(" ")
            if not stack or not cycles.isdecimal():
                raise SchemaError(f"{path}:{number}: the line is not a stack with its cycles: the file is damaged or was cut short")
            stacks[stack] = int(cycles)
        return stacks

    @property
    def map_names(self) -> list[str]:
        """Returns the names of the maps of cost by pixel that the run left in `heat/`, or [] when it left none."""
        return sorted(path.stem for path in (self.directory / "heat").glob("*.npy"))

    def map_info(self, name: str) -> Facts:
        """Returns unit, meaning, sum, smallest, mean, 99th percentile (p99) and largest value of a map of cost, from `heat/maps.json`."""
        path = self.file("heat/maps.json", "`glint run --heat`")
        maps = read_json(path).get("maps")
        if not isinstance(maps, list) or not all(isinstance(one, dict) for one in maps):
            raise SchemaError(f"{path}: there is no list of maps: the file is damaged, or of another version of Glint")
        for one in maps:
            if one.get("name") == name:
                missing = [fact for fact in ("unit", "p99", "max") if fact not in one]
                if missing:
                    raise SchemaError(f"{path}: '{name}' has no {', '.join(missing)}: the file is damaged, or of another version of Glint")
                return Facts(one)
        raise UnknownName(f"{self.directory}: heat/maps.json has no '{name}'{near(name, self.map_names)}")

    def map(self, name: str) -> Any:
        """Returns a map of cost by pixel: an array of the shape (height, width)."""
        if name not in self.map_names:
            raise MissingFile(f"{self.directory}: there is no map '{name}'; the run has: {', '.join(self.map_names) or 'none (`glint run --heat` writes them)'}")
        return read_map(self.file(f"heat/{name}.npy"))

    def file(self, name: str, written_by: str = "the run") -> pathlib.Path:
        """Returns the path of a file of the run.

        Raises MissingFile, which says what writes the file, when it is missing, and SchemaError when it is not as the run left it.
        """
        path = self.directory / name
        if not path.is_file():
            raise MissingFile(f"{self.directory}: there is no {name}, which is written by {written_by}")
        self._files.check(name)
        return path
