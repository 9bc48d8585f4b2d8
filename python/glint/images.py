# Reads pictures and maps of a run: PFM and NPY in this file, PNG by matplotlib.
# SPDX-License-Identifier: Apache-2.0
"""Arrays have shape (height, width, channels) or (height, width), row 0 at the top."""
from __future__ import annotations

import math
import pathlib
from typing import Any

from .errors import MissingFile, SchemaError
from .optional import require


def read_image(path: str | pathlib.Path) -> Any:
    """Returns a picture as a numpy array: PFM as the float32 values that the shader wrote, PNG in [0, 1] in 255 steps, NPY unchanged.

    Colours give the shape (height, width, 3), without transparency; grey gives (height, width).

    Raises MissingFile, SchemaError (the file is damaged or of another kind) and MissingPackage (numpy; matplotlib for PNG).
    """
    path = pathlib.Path(path)
    if not path.is_file():
        raise MissingFile(f"{path}: there is no such picture")
    if path.suffix == ".pfm":
        return _read_pfm(path)
    if path.suffix == ".npy":
        return read_map(path)
    if path.suffix == ".png":
        return _read_png(path)
    raise SchemaError(f"{path}: pictures are .pfm, .png or .npy")


def read_map(path: pathlib.Path) -> Any:
    """Returns a NumPy file as an array. Raises SchemaError when it is not one."""
    numpy = require("numpy", "reading maps")
    try:
        return numpy.load(path, allow_pickle=False)
    except (ValueError, EOFError) as error:
        raise SchemaError(f"{path}: this is not a NumPy file: {error}") from error


def _read_png(path: pathlib.Path) -> Any:
    imread = require("matplotlib.image", "reading PNG").imread
    try:
        pixels = imread(path)
    except (OSError, SyntaxError, ValueError) as error:  # Pillow raises these for damaged files
        raise SchemaError(f"{path}: this is not a PNG picture, or it was cut short: {error}") from error
    if pixels.ndim == 2:
        return pixels
    return pixels[..., 0] if pixels.shape[2] == 2 else pixels[..., :3]  # the last of two or four channels is transparency


def _read_pfm(path: pathlib.Path) -> Any:
    numpy = require("numpy", "reading pictures")
    with open(path, "rb") as file:
        try:
            kind = file.readline().strip()
            width, height = (int(word) for word in file.readline().split())
            scale = float(file.readline())
            channels = {b"PF": 3, b"Pf": 1}[kind]
        except (KeyError, ValueError) as error:
            raise SchemaError(f"{path}: this is not a PFM picture") from error
        if width < 1 or height < 1 or scale == 0 or not math.isfinite(scale):
            raise SchemaError(f"{path}: {width} by {height} pixels, scale {scale:g}: this is not a PFM picture")
        data = file.read()
    if len(data) != width * height * channels * 4:
        raise SchemaError(f"{path}: {len(data)} bytes of pixels, {width * height * channels * 4} expected: the file was cut short")
    values = numpy.frombuffer(data, "<f4" if scale < 0 else ">f4").astype(numpy.float32)
    shape = (height, width, 3) if channels == 3 else (height, width)
    return values.reshape(shape)[::-1].copy()  # PFM begins with the lowest row
