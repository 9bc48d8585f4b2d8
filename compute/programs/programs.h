// Declares the programs, which stand in a file each; program.cpp has their table.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "compute/host.h"

namespace glint::compute {

void bfs(Host& host, Size size);
void hotspot(Host& host, Size size);
void pathfinder(Host& host, Size size);

}  // namespace glint::compute
