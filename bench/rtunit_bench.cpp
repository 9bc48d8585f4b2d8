// Measures the node visits per second of the functional traversal and of the timed RT unit.
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/rt_launch.h"

namespace glint::rt::test {
namespace {

struct Scene {
  mem::AddressSpace memory;
  Positions positions;
  StructureInfo top;
  std::vector<WarpRays> rays;
  explicit Scene(uint32_t triangles_count, size_t warps, const std::string& format = "bvh6") {
    Random random{42};
    positions = soup(random, triangles_count, 10, 20 / std::cbrt(float(triangles_count)));
    BuildOptions options;
    options.format.name = format;
    top = single(memory, triangles(positions), options);
    rays.resize(warps);
    for (WarpRays& warp : rays)
      for (RayState& state : warp) {
        state = ray_of(top.address, random.point(12), random.point(1));
        begin(state, memory);
      }
  }
};

void functional(benchmark::State& bench, const std::string& format) {
  const Scene scene(uint32_t(bench.range(0)), 64, format);
  uint64_t visits = 0;
  for (auto _ : bench)
    for (const WarpRays& warp : scene.rays)
      for (const RayState& start : warp) {
        RayState state = ray_of(scene.top.address, start.ray.origin, start.ray.direction);
        begin(state, scene.memory);
        run(state, scene.memory);
        visits += state.nodes_visited;
        benchmark::DoNotOptimize(state.committed.t);
      }
  bench.counters["visits"] = benchmark::Counter(double(visits), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(functional, bvh2, "bvh2")->Arg(1000);
BENCHMARK_CAPTURE(functional, bvh4, "bvh4")->Arg(1000);
BENCHMARK_CAPTURE(functional, bvh6, "bvh6")->Arg(1000)->Arg(100000);
BENCHMARK_CAPTURE(functional, bvh8, "bvh8")->Arg(1000);

void timed(benchmark::State& bench) {
  Scene scene(uint32_t(bench.range(0)), 64);
  uint64_t visits = 0, cycles = 0;
  for (auto _ : bench) {
    bench.PauseTiming();
    auto rays = scene.rays;
    bench.ResumeTiming();
    mem::FixedLatencyMemory l1(30, 1);
    RtUnit unit({}, {scene.memory, l1});
    cycles += launch(unit, l1, rays, bench.range(1) != 0).last_completion;
    visits += unit.stats().nodes.value();
  }
  bench.counters["visits"] = benchmark::Counter(double(visits), benchmark::Counter::kIsRate);
  bench.counters["cycles"] = benchmark::Counter(double(cycles), benchmark::Counter::kIsRate);
}
BENCHMARK(timed)->Args({1000, 0})->Args({100000, 0})->Args({100000, 1});

}  // namespace
}  // namespace glint::rt::test

BENCHMARK_MAIN();
