# Packages that only some functions need, imported when they do.
# SPDX-License-Identifier: Apache-2.0
"""numpy, pandas and matplotlib are not needed to read runs; what needs them asks here."""
import importlib
from types import ModuleType

from .errors import MissingPackage

_DEBIAN = {"numpy": "python3-numpy", "pandas": "python3-pandas", "matplotlib": "python3-matplotlib"}


def require(name: str, purpose: str) -> ModuleType:
    """The module `name`; MissingPackage, which names the package to install, where it is not there."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        package = name.split(".")[0]
        raise MissingPackage(f"{purpose} needs {package}, which is not installed for {_interpreter()}: "
                             f"install {_DEBIAN.get(package, package)} ({error})") from error


def _interpreter() -> str:
    import sys
    return sys.executable or "this Python"
