// Tests when the blocks of a kernel start: intervals, clusters of one block, places that become free.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <vector>

#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

TEST_CASE("blocks of a grid start at their interval, whatever core they are on") {
  Launcher k(storing("mov.u32 %out, 1;\n"), "test.ptx", "k");
  k.buffer(std::vector<uint32_t>(32));
  const auto cycles = [&](double interval) {
    pipeline::GpuParams gpu;
    gpu.core.block_interval = 0;
    gpu.core.grid_interval = interval;
    return k.run_timing({{33, 1, 1}, {32, 1, 1}, 0}, gpu);
  };
  // The last block starts long after the first has filled the caches.
  CHECK(cycles(40.5) == cycles(20.25) + 648);  // 32 times 20.25
}

TEST_CASE("blocks that are clusters start at an interval of their own") {
  std::string text = storing("mov.u32 %out, 1;\n");
  const auto cycles = [](const std::string& kernel, double interval) {
    Launcher k(kernel, "test.ptx", "k");
    k.buffer(std::vector<uint32_t>(32));
    pipeline::GpuParams gpu;
    gpu.core.grid_interval = 20.25;
    gpu.core.cluster_interval = interval;
    return k.run_timing({{33, 1, 1}, {32, 1, 1}, 0}, gpu);
  };
  const auto plain = cycles(text, 0);
  CHECK(cycles(text, 40.5) == plain);
  text.insert(text.find('{'), ".reqnctapercluster 1, 1, 1\n");
  CHECK(cycles(text, 0) == plain);
  CHECK(cycles(text, 40.5) == plain + 648);
  text.replace(text.find("cluster 1"), 9, "cluster 2");
  CHECK_THROWS_WITH(cycles(text, 0), Catch::Contains("a cluster of 2 x 1 x 1 blocks"));
}

TEST_CASE("a block takes the place of another after the refill latency") {
  Launcher k(storing("mov.u32 %out, 1;\n"), "test.ptx", "k");
  k.buffer(std::vector<uint32_t>(32));
  const auto cycles = [&](uint32_t latency) {
    pipeline::GpuParams gpu;
    gpu.cores = 1;
    gpu.core.blocks = 1;
    gpu.core.refill_latency = latency;
    return k.run_timing({{5, 1, 1}, {32, 1, 1}, 0}, gpu);
  };
  CHECK(cycles(700) == cycles(500) + 4 * 200);
}
