# What can be wrong with a run directory or with what is asked of it: every error says what to do.
# SPDX-License-Identifier: Apache-2.0
"""Errors of the reader. All of them are `GlintError`."""


class GlintError(Exception):
    """Base of all errors of this package."""


class MissingFile(GlintError):
    """A run has no such file; the message names the option of `glint run` that writes it."""


class IncompleteRun(GlintError):
    """The run did not end, or ended with an error: its numbers are not those of a whole run."""


class SchemaError(GlintError):
    """The files are of another schema than this package reads, or are damaged."""


class UnknownName(GlintError, KeyError):
    """No statistic, key or metric of this name; the message lists near ones."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class MissingPackage(GlintError, ImportError):
    """An optional package (numpy, pandas, matplotlib) is needed for this and not installed."""


class CommandFailed(GlintError):
    """`glint` could not be found or ended with an error.

    Attributes:
        code: exit code of the command (docs/errors.md), or None where it was not found.
        output: what it wrote on stderr.
    """

    def __init__(self, message: str, code: int | None = None, output: str = ""):
        super().__init__(message)
        self.code = code
        self.output = output
