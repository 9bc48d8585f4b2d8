# Imports packages that only some functions need, at the time they need them.
# SPDX-License-Identifier: Apache-2.0
"""Reading runs does not need numpy, pandas or matplotlib. Functions that need them call `require`."""
import importlib
from types import ModuleType

from .errors import MissingPackage

_DEBIAN = {"numpy": "python3-numpy", "pandas": "python3-pandas", "matplotlib": "python3-matplotlib", "scipy": "python3-scipy",
           "distributed": "python3-distributed", "pyarrow": "it with `pip install pyarrow` (Debian 12 has no package of it)"}


def require(name: str, purpose: str) -> ModuleType:
    """Returns the module `name`. Raises MissingPackage, which names the package to install, when it is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        package = name.split(".")[0]
        raise MissingPackage(f"{purpose} needs {package}, which is not installed for {_interpreter()}: "
                             f"install {_DEBIAN.get(package, package)} ({error})") from error


def _interpreter() -> str:
    import sys
    return sys.executable or "this Python"
