# Chooses the points of a sweep: whole grids, lists, and samples of ranges.
# SPDX-License-Identifier: Apache-2.0
"""`points_of(...)` gives the settings of each point of one `[[design]]` table."""
from __future__ import annotations

import itertools
import math
import random
from typing import Any, Mapping, Sequence

from ..errors import SweepError
from ..optional import require

METHODS = ("grid", "list", "random", "latin-hypercube", "sobol", "saltelli")


class Axis:
    """Holds what a key may be: a list of values, or a range {low, high, step, scale, integer}.

    Raises SweepError when it is neither.
    """

    def __init__(self, key: str, given: Any):
        self.key = key
        self.values: list[Any] | None = None
        if isinstance(given, Mapping):
            self._read_range(dict(given))
        elif isinstance(given, (list, tuple)) and given:
            check_values(key, given)
            self.values = list(given)
        else:
            raise SweepError(f"'{key}' is {given!r}: a list of values is needed, or a range {{ low = 1, high = 8 }}")

    def _read_range(self, given: dict[str, Any]) -> None:
        unknown = set(given) - {"low", "high", "step", "scale", "integer"}
        if unknown or not {"low", "high"} <= set(given):
            raise SweepError(f"'{self.key}' has {sorted(unknown or given)}: a range has low and high, and may have step, scale and integer")
        self.low, self.high, self.step, self.scale = given["low"], given["high"], given.get("step"), given.get("scale", "linear")
        for name in ("low", "high", "step"):
            value = given.get(name)
            if value is not None and (isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value)):
                raise SweepError(f"'{self.key}' has {name} = {value!r}, which is not a number")
        whole = all(value == int(value) for value in (self.low, self.high, self.step or 1))
        self.integer = given.get("integer", all(isinstance(value, int) for value in (self.low, self.high, self.step or 1)))
        if not isinstance(self.integer, bool):
            raise SweepError(f"'{self.key}' has integer = {self.integer!r}: it is true or false")
        if self.integer and not whole:
            raise SweepError(f"'{self.key}' has integer = true, and one of low, high and step is no whole number")
        if self.low >= self.high:
            raise SweepError(f"'{self.key}' has low = {self.low}, which is not below high = {self.high}")
        if self.step is not None and self.step <= 0:
            raise SweepError(f"'{self.key}' has step = {self.step}, which is not above 0")
        if self.scale not in ("linear", "log", "power2"):
            raise SweepError(f"'{self.key}' has scale = {self.scale!r}: it is \"linear\", \"log\" or \"power2\"")
        if self.scale != "linear" and self.low <= 0:
            raise SweepError(f"'{self.key}' has low = {self.low}: a range with scale = \"{self.scale}\" begins above 0")
        if self.scale == "power2" and self.step is not None:
            raise SweepError(f"'{self.key}' has a step: a range with scale = \"power2\" has the powers of two, and no step")
        if self.scale == "power2" and not self.all_values():
            raise SweepError(f"'{self.key}' has no power of two from low = {self.low} to high = {self.high}")

    def all_values(self) -> list[Any]:
        """Returns every value. Raises SweepError for a range without a step."""
        if self.values is not None:
            return self.values
        if self.scale == "power2":
            return [2**i for i in range(math.ceil(math.log2(self.low)), math.floor(math.log2(self.high)) + 1)]
        if self.step is None:
            raise SweepError(f"'{self.key}' is a range without a step: a grid needs one, or scale = \"power2\"")
        return [self._at_step(i) for i in range(self._num_steps() + 1)]

    def count(self) -> int:
        """Returns the number of all_values(), without making them."""
        if self.values is None and self.scale != "power2" and self.step is not None:
            return self._num_steps() + 1
        return len(self.all_values())

    def at(self, part: float) -> Any:
        """Returns the value at a part from 0 up to 1 of the axis."""
        if self.values is not None or self.scale == "power2":
            values = self.all_values()
            return values[min(int(part * len(values)), len(values) - 1)]
        if self.scale == "log":
            value = math.exp(math.log(self.low) + part * (math.log(self.high) - math.log(self.low)))
            return self._plain(value) if self.step is None else self._at_step(min(round((value - self.low) / self.step), self._num_steps()))
        if self.step is not None:
            return self._at_step(min(int(part * (self._num_steps() + 1)), self._num_steps()))
        if self.integer:
            return min(self.low + int(part * (self.high - self.low + 1)), self.high)
        return self._plain(self.low + part * (self.high - self.low))

    def _num_steps(self) -> int:
        """Returns how many steps lie between the ends of a range."""
        return math.floor((self.high - self.low) / self.step + 1e-9)

    def _at_step(self, number: int) -> Any:
        return self._plain(self.low + number * self.step)

    def _plain(self, value: float) -> Any:
        return round(value) if self.integer else float(f"{value:.12g}")


def check_values(key: str, values: Sequence[Any]) -> None:
    """Raises SweepError when a value stands twice in a list."""
    known = set()
    for value in values:
        if repr(value) in known:
            raise SweepError(f"'{key}' has {value!r} twice: remove one of them")
        known.add(repr(value))


def number_of_points(method: str, keys: Mapping[str, Any], count: int | None, listed: list[Mapping[str, Any]]) -> int:
    """Returns how many points points_of() gives, without making them. What is missing is told by points_of()."""
    if method == "list":
        return len(listed)
    if method == "grid":
        return math.prod(Axis(key, given).count() for key, given in keys.items())
    return (count or 0) * (len(keys) + 2 if method == "saltelli" else 1)


def points_of(method: str, keys: Mapping[str, Any], count: int | None, seed: int, listed: list[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Returns the settings of the points of a design, in its order.

    Args:
        method: One of METHODS.
        keys: What each key may be (see Axis).
        count: The number of points to sample; of base points for "saltelli", which gives count * (keys + 2).
        seed: The seed of the samples. The same seed gives the same points.
        listed: The points of the method "list".
    """
    if method == "list":
        return [dict(point) for point in listed]
    axes = [Axis(key, given) for key, given in keys.items()]
    if method == "grid":
        return [dict(zip(keys, values)) for values in itertools.product(*(axis.all_values() for axis in axes))]
    if count is None:
        raise SweepError(f"the method \"{method}\" needs `points`, the number of points")
    if not axes:
        raise SweepError(f"the method \"{method}\" needs keys: [design.keys]")
    unit = {"random": _random, "latin-hypercube": _latin_hypercube, "sobol": _sobol, "saltelli": _saltelli}[method](len(axes), count, seed)
    return [{axis.key: axis.at(part) for axis, part in zip(axes, row)} for row in unit]


def _random(dimensions: int, count: int, seed: int) -> list[list[float]]:
    source = random.Random(seed)
    return [[source.random() for _ in range(dimensions)] for _ in range(count)]


def _latin_hypercube(dimensions: int, count: int, seed: int) -> list[list[float]]:
    """Returns points of which every of `count` slices of every axis has one."""
    source = random.Random(seed)
    columns = []
    for _ in range(dimensions):
        slices = list(range(count))
        source.shuffle(slices)
        columns.append([(one + source.random()) / count for one in slices])
    return [list(row) for row in zip(*columns)]


def _sobol(dimensions: int, count: int, seed: int, method: str = "sobol") -> list[list[float]]:
    qmc = require("scipy.stats", f"the method \"{method}\"").qmc
    import warnings
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # It warns of counts that are no powers of two.
        try:
            return [list(map(float, row)) for row in qmc.Sobol(dimensions, scramble=True, seed=seed).random(count)]
        except ValueError as error:
            raise SweepError(f"the method \"{method}\" cannot give {count} points in {dimensions} dimensions: {error}") from error


def _saltelli(dimensions: int, count: int, seed: int) -> list[list[float]]:
    """Returns the rows A, B, AB_1 .. AB_d of each base point, in that order, as Saltelli et al. (2010) describe them."""
    out: list[list[float]] = []
    for row in _sobol(2 * dimensions, count, seed, "saltelli"):
        a, b = row[:dimensions], row[dimensions:]
        out += [a, b, *([*a[:i], b[i], *a[i + 1:]] for i in range(dimensions))]
    return out
