# Defines the errors of runs and requests. Every error says what to do.
# SPDX-License-Identifier: Apache-2.0
"""Every error of this package is a `GlintError`."""


class GlintError(Exception):
    """Serves as the base class of all errors of this package."""


class MissingFile(GlintError):
    """A run has no such file. The message names the option of `glint run` that writes it."""


class IncompleteRun(GlintError):
    """The run did not end, or ended with an error, so its numbers are not those of a whole run."""


class SchemaError(GlintError):
    """The files have another schema than this package reads, or are damaged."""


class UnknownName(GlintError, KeyError):
    """There is no statistic, key or metric of this name. The message lists similar names."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class MissingPackage(GlintError, ImportError):
    """A function needs an optional package (numpy, pandas, matplotlib) that is not installed."""


class CommandFailed(GlintError):
    """`glint` could not be found or ended with an error.

    Attributes:
        code: The exit code of the command (docs/errors.md), or None when it was not found.
        output: The text that it wrote on stderr.
    """

    def __init__(self, message: str, code: int | None = None, output: str = ""):
        super().__init__(message)
        self.code = code
        self.output = output


class SweepError(GlintError):
    """A sweep, one of its points or a store cannot be used as it is. The message says what to change."""


class StoreFull(SweepError):
    """A store, or the folder for the files of runs, takes no further file. What is done stays, and the sweep goes on when this is mended."""
