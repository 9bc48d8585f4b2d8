# Says what `glint paper` runs: sets of workloads, each on one machine, and which table or figure each is for.
# SPDX-License-Identifier: Apache-2.0
"""`plan(options)` gives the sets. A set is one `glint bench`, or one `glint ablate`, with a folder of its own."""
from __future__ import annotations

import dataclasses
from typing import Iterator

SUBSET = ("SPNZA_AO", "BUNNY_AO", "WKND_PT", "SHIP_SH", "ROBOT_SH", "BATH_PT", "PARK_PT", "CHSNT_PT")  # Table 2
SERIES = ("PARK_PT", "BUNNY_AO", "SHIP_SH")  # Figure 6
MACHINES = ("mobile", "desktop", "vulkan-sim-mobile", "vulkan-sim-desktop", "lumibench")
COMPUTE_MACHINES = ("mobile", "vulkan-sim-mobile")  # have the compute suite
DESKTOP_OF = {"mobile": "desktop", "vulkan-sim-mobile": "vulkan-sim-desktop", "lumibench": "vulkan-sim-desktop"}
JUDGED_MACHINES = tuple(DESKTOP_OF)  # have series, large frames and twice the bandwidth, too, so that every statement can be judged
TWICE_THE_BUS = "memory.dram.bus_bytes=4"  # All of these have 2.
# The configuration that the paper checks its subset with "adjusts the number of cores, cache size, intersection latencies, and the number of
# warps per RT unit" and has no numbers. Choice: twice or half of each, one by one and together.
VARIANTS = {
    "cores": ("cores=16",),
    "caches": ("memory.l1.size=131072", "memory.l2.slice_size=1572864"),
    "latencies": ("rt.box.latency=26", "rt.triangle.latency=74", "rt.transform.latency=16"),
    "rt-warps": ("rt.warps=8",),
}
VARIANTS["all"] = tuple(setting for settings in tuple(VARIANTS.values()) for setting in settings)
_COST = {"desktop": 1.3, "vulkan-sim-mobile": 3.0, "vulkan-sim-desktop": 3.0, "lumibench": 2.5}  # seconds of a workload, those on mobile being 1


@dataclasses.dataclass(frozen=True)
class Options:
    """Says how much is run. `names` replaces the workloads of scenes, and `programs` those of compute, in trials."""

    subset: bool = False
    assets: str = ""
    size: str = "128x128"
    spp: int = 2
    small: bool = False  # programs run on their small inputs
    names: tuple[str, ...] = ()
    programs: tuple[str, ...] = ()


@dataclasses.dataclass(frozen=True)
class Set:
    """One folder of runs: `name` is its path below `runs`, `shows` what it is for, `words` the command without folder and number of processes."""

    name: str
    shows: str
    words: tuple[str, ...]
    weight: float  # processor seconds, roughly

    @property
    def is_ablation(self) -> bool:
        return self.words[0] == "ablate"


def suite_of(options: Options) -> tuple[str, ...]:
    return options.names or (("subset",) if options.subset else ("lumibench",))


def _count(names: tuple[str, ...]) -> int:
    return {("subset",): 8, ("lumibench",): 46, ("compute",): 13}.get(names, len(names))


def plan(options: Options) -> list[Set]:
    """Returns the sets, in the order in which they run: what every figure needs comes first."""
    return list(_sets(options))


def _sets(options: Options) -> Iterator[Set]:
    suite = suite_of(options)
    for form in ("generated",) + (("files",) if options.assets else ()):
        for machine in MACHINES:
            yield _bench(options, f"{form}/{machine}", "Tables 1 and 2; Figures 3, 4, 7 to 14", suite, machine, form=form)
    trial = options.names
    programs = options.programs or ("compute",)
    for machine in COMPUTE_MACHINES:
        yield _bench(options, f"compute/{machine}", "section 3.4.1; Figures 3 and 15", programs, machine)
    for machine in JUDGED_MACHINES:
        yield _bench(options, f"series/{machine}", "Figure 6", tuple(n for n in SERIES if not trial or n in trial) or suite, machine, more=("--sample", "1000" if trial else "5000"))
    party = trial[:1] or ("PARTY_PT",)
    for machine in JUDGED_MACHINES:
        yield _bench(options, f"bandwidth/{machine}", "section 5.3.2", party, machine)
        yield _bench(options, f"bandwidth/{machine}-twice", "section 5.3.2", party, machine, settings=(TWICE_THE_BUS,))
    for machine in JUDGED_MACHINES:
        size = ("64x64", 1) if trial else ("1920x1080", 1)
        yield _bench(options, f"large/{machine}", "Figure 6", trial[:1] or ("SHIP_SH",), machine, frame=size, scale=60)
    for name, settings in VARIANTS.items():
        yield _bench(options, f"variants/{name}", "section 3.4", suite, "mobile", settings=settings)
    if not options.subset:
        words = ("ablate", "mobile", "vulkan-sim-mobile", "--workloads", *(options.names or ("subset",)), "--size", options.size, "--spp", str(options.spp))
        yield Set("ablation", "the cause of each statement", words, 63 * 1.9 * 6 * _count(options.names or ("subset",)))


def _bench(options: Options, name: str, shows: str, names: tuple[str, ...], machine: str, *, form: str = "generated", settings: tuple[str, ...] = (),
           more: tuple[str, ...] = (), frame: tuple[str, int] | None = None, scale: float = 1) -> Set:
    words = ["bench", *names, "--config", machine]
    for setting in settings:
        words += ["--set", setting]
    if name.startswith("compute/"):
        words += ["--small"] if options.small else []
        scale *= 2
    else:
        size, spp = frame or (options.size, options.spp)
        words += ["--size", size, "--spp", str(spp)]
    words += ["--assets", options.assets] if form == "files" else []
    return Set(name, shows, (*words, *more, "--stats", "compact"), 6 * _count(names) * _COST.get(machine, 1.0) * scale)
