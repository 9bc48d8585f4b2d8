// Runs a launch functionally and leaves in a device's caches what it has touched.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/device.h"

namespace glint::pipeline {

// Runs the launch on the functional machine and lets the device's L2 hold the lines that it touches, on top
// of what launches before it have left, or, with cold caches, of nothing. The result has counts and no
// statistics. A launch that the watch stops leaves empty caches. Throws as run_functional() does. Model:
// lines that the launch writes are written back by later launches, and never by itself.
RenderResult warm_launch(const exec::World& world, const GpuParams& gpu, Caches caches, Device& device,
                         const LaunchWatch& watch);

}  // namespace glint::pipeline
