# Is the program behind `glint paper`.
# SPDX-License-Identifier: Apache-2.0
"""usage: python3 -m glint.paper [OPTION...]"""
import sys

from .command import main

if __name__ == "__main__":
    sys.exit(main())
