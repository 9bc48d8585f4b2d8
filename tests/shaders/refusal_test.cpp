// What the frontend refuses: everything at once, by name, with file and line; and mistakes in included files.
// SPDX-License-Identifier: Apache-2.0
#include "base/diagnostics.h"
#include "tests/shaders/ray_lab.h"
#include "tests/support/catch.h"
