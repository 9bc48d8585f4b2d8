// Declares the programs, which stand in a file each; program.cpp has their table.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "compute/host.h"

namespace glint::compute {

void backprop(Host& host, Size size);
void bfs(Host& host, Size size);
void btree(Host& host, Size size);
void gaussian(Host& host, Size size);
void hotspot(Host& host, Size size);
void kmeans(Host& host, Size size);
void lavamd(Host& host, Size size);
void lud(Host& host, Size size);
void nn(Host& host, Size size);
void nw(Host& host, Size size);
void pathfinder(Host& host, Size size);
void srad(Host& host, Size size);
void streamcluster(Host& host, Size size);

}  // namespace glint::compute
