// Measures how fast the host simulates the memory system, in accesses per second, by where they are served.
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>
#include <cstdint>
#include <random>
#include <vector>

#include "memsys/dram/dram_channel.h"
#include "memsys/memory_system.h"
#include "tests/support/memory_rig.h"

namespace {

using namespace glint;
using namespace glint::mem;

// Runs windows as the engine does. One core tries one access per cycle, over `lines` in order.
void run(benchmark::State& state, const Params& params, const std::vector<Address>& lines) {
  stats::Group root(nullptr, "bench");
  MemorySystem memory(params, 1, 1365.0, &root);
  L1Cache& l1 = memory.l1(0);
  const std::vector<Cell*> cells = memory.cells();
  const std::vector<ChannelBase*> channels = memory.channels();
  const Cycle window = memory.shortest_latency();
  Cycle now = 0;
  size_t next = 0;
  uint64_t accepted = 0;
  for (auto _ : state) {
    for (const uint64_t goal = accepted + 10000; accepted < goal;) {
      for (ChannelBase* channel : channels) channel->deliver();
      for (Cycle c = now; c < now + window; ++c) {
        l1.tick(c);
        while (l1.pop(c, Client::RtUnit)) {
        }
        if (l1.access(c, Client::RtUnit, {lines[next], 1, false, Traffic::RtNode, 0})) {
          ++accepted;
          if (++next == lines.size()) next = 0;
        }
      }
      for (Cell* cell : cells) cell->advance(now, now + window);
      now += window;
    }
  }
  uint64_t dram = 0;
  for (uint32_t p = 0; p < memory.num_partitions(); ++p)
    dram += memory.partition(p).dram().stats().reads.value();
  state.counters["accesses/s"] = benchmark::Counter(double(accepted), benchmark::Counter::kIsRate);
  state.counters["dram/s"] = benchmark::Counter(double(dram), benchmark::Counter::kIsRate);
  state.counters["cycles/s"] = benchmark::Counter(double(now), benchmark::Counter::kIsRate);
}

std::vector<Address> random_lines(uint32_t count) {
  std::mt19937 random(1);
  std::vector<Address> lines(1 << 16);
  for (Address& line : lines) line = Address{random() % count} * 128;
  return lines;
}

void l1_hits(benchmark::State& state) {
  run(state, bare(), random_lines(128));
}
void l2_hits(benchmark::State& state) {
  run(state, bare(), random_lines(3000));
}
void dram_random(benchmark::State& state) {
  run(state, bare(), random_lines(1 << 20));
}
void dram_random_defaults(benchmark::State& state) {
  run(state, {}, random_lines(1 << 20));
}
void dram_random_simple(benchmark::State& state) {
  Params p = bare();
  p.dram.model = PolicyChoice<DramModel>("simple");
  run(state, p, random_lines(1 << 20));
}
void dram_stream(benchmark::State& state) {
  std::vector<Address> lines(1 << 16);
  for (size_t i = 0; i < lines.size(); ++i) lines[i] = i * 128;
  run(state, bare(), lines);
}

// Runs one channel by itself and keeps its queue full of random sectors.
void dram_channel_random(benchmark::State& state) {
  stats::Group root(nullptr, "bench");
  const DramParams params = bare().dram;
  DramChannel channel({params, 256, 1365.0, &root});
  std::mt19937_64 random(1);
  uint64_t requests = 0;
  for (auto _ : state) {
    for (const uint64_t goal = requests + 10000; requests < goal;) {
      const Cycle now = channel.next_command() == kNever ? 0 : channel.next_command();
      channel.advance(now);
      while (!channel.returns().empty()) channel.returns().pop();
      for (; !channel.full(); ++requests) channel.add(now, 0, 1, random() % (1u << 27), false);
    }
  }
  state.counters["dram/s"] = benchmark::Counter(double(requests), benchmark::Counter::kIsRate);
}
BENCHMARK(dram_channel_random)->Unit(benchmark::kMillisecond);
BENCHMARK(l1_hits)->Unit(benchmark::kMillisecond);
BENCHMARK(l2_hits)->Unit(benchmark::kMillisecond);
BENCHMARK(dram_random)->Unit(benchmark::kMillisecond);
BENCHMARK(dram_random_defaults)->Unit(benchmark::kMillisecond);
BENCHMARK(dram_random_simple)->Unit(benchmark::kMillisecond);
BENCHMARK(dram_stream)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
