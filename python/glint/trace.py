# Reads what `glint run --trace` writes: what each warp and each place of the RT units did, cycle by cycle.
# SPDX-License-Identifier: Apache-2.0
"""`Trace(path)` reads trace.json.gz, which is in Chrome's trace event format (docs/profiling.md)."""
from __future__ import annotations

import dataclasses
import gzip
import json
import pathlib
import zlib

from .errors import GlintError, MissingFile, SchemaError

_FIRST_SM = 2  # process of SM 0 in the file
_RT_TRACKS = 1001  # number of the first track of an RT unit; warp slots count from 1


@dataclasses.dataclass(frozen=True)
class Slice:
    """Holds something that lasted: a warp, a shader stage, what the warp did (`state`), or its rays in the RT unit (`rays`).

    Attributes:
        track: The number of the warp slot, or of the place in the RT unit's warp buffer for `rays`, from 0.
        kind: "warp", "stage", "state" or "rays".
        name: For a state, "running" or a reason of docs/profiling.md.
        begin, length: Cycles.
    """
    track: int
    kind: str
    name: str
    begin: int
    length: int

    @property
    def end(self) -> int:
        return self.begin + self.length


class Trace:
    """Holds a trace.

    Attributes:
        begin, end: The cycles that it covers.
        sms: The number of SMs.
        is_cut: Whether it ended early because `--trace-limit` was reached.
    """

    def __init__(self, path: str | pathlib.Path):
        self.path = pathlib.Path(path)
        if not self.path.is_file():
            raise MissingFile(f"{self.path}: there is no such file; `glint run --trace` writes it")
        try:
            tree = json.loads(gzip.decompress(self.path.read_bytes()))
            about = tree["otherData"]
            self.begin, self.end, self.sms, self.is_cut = int(about["begin"]), int(about["end"]), int(about["cores"]), bool(about["cut"])
            self._slices: dict[int, list[Slice]] = {}
            for event in tree["traceEvents"]:
                sm = event["pid"] - _FIRST_SM
                if event["ph"] == "X" and 0 <= sm < self.sms:
                    track = event["tid"] - (_RT_TRACKS if event["cat"] == "rays" else 1)
                    self._slices.setdefault(sm, []).append(Slice(track, event["cat"], event["name"], event["ts"], event["dur"]))
        except (OSError, EOFError, zlib.error, ValueError, KeyError, TypeError) as error:
            raise SchemaError(f"{self.path}: this is not a trace of `glint run --trace`: {error}") from None

    def slices(self, sm: int = 0) -> list[Slice]:
        """Returns the slices of an SM in the order of the file. Raises GlintError when there is no such SM."""
        if not 0 <= sm < self.sms:
            raise GlintError(f"{self.path}: there is no SM {sm}: the run has the SMs 0 to {self.sms - 1}")
        return self._slices.get(sm, [])
