# Runs one process of a point: within limits of time and memory, and never longer than its parent lives.
# SPDX-License-Identifier: Apache-2.0
"""`run_process(...)` returns how a process ended, and what it took."""
from __future__ import annotations

import dataclasses
import os
import pathlib
import select
import shutil
import subprocess
import time
from typing import Callable

_LOG = 65536  # bytes of a log that are kept, the last ones
_TURN = 0.5  # seconds between looks at whether to stop


@dataclasses.dataclass
class Ended:
    """Says how a process ended: its exit code (below 0: the signal that ended it), and the limit that ended it, if one did."""
    code: int
    seconds: float
    peak_bytes: int
    by: str = ""  # "timeout" or "stop"


def run_process(words: list[str], log: pathlib.Path, timeout: float | None, memory: int | None, stop: Callable[[], bool], environment: dict[str, str] | None = None,
                errors: pathlib.Path | None = None) -> Ended:
    """Runs a command with its output in `log`, and waits for its end.

    Args:
        timeout: Seconds after which it is killed, or None.
        memory: Bytes of addresses that it may have, or None.
        stop: Says whether the sweep is to end. The process is killed then.
        environment: Its variables, or None for those of this process.
        errors: The file of what it writes on stderr, or None for `log`.
    """
    start = time.monotonic()
    with open(log, "wb") as out, open(errors or os.devnull, "wb") as err:
        child = subprocess.Popen(_limited(memory) + words, stdin=subprocess.DEVNULL, stdout=out, stderr=err if errors else subprocess.STDOUT, start_new_session=True, env=environment)
    by, pidfd = "", os.pidfd_open(child.pid)
    try:
        while not select.select([pidfd], [], [], _wait(start, timeout))[0]:
            by = "stop" if stop() else "timeout" if timeout is not None and time.monotonic() - start >= timeout else ""
            if by:
                child.kill()
                break
    except BaseException:
        child.kill()
        raise
    finally:
        os.close(pidfd)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    return Ended(child.returncode, time.monotonic() - start, usage.ru_maxrss * 1024, by)


def tail(log: pathlib.Path) -> str:
    """Returns the end of a log."""
    try:
        with open(log, "rb") as file:
            file.seek(max(0, log.stat().st_size - _LOG))
            return file.read().decode("utf-8", "replace")
    except OSError:
        return ""


def _wait(start: float, timeout: float | None) -> float:
    return _TURN if timeout is None else max(0.0, min(_TURN, start + timeout - time.monotonic()))


def _limited(memory: int | None) -> list[str]:
    """Returns the words before a command that limit its addresses, and end it when its parent is killed."""
    words = [found, f"--as={memory}"] if memory and (found := shutil.which("prlimit")) else []
    setpriv = shutil.which("setpriv")
    return words + ([setpriv, "--pdeathsig", "KILL", "--"] if setpriv else [])
