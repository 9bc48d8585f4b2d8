// Where the time of a miss goes: the stages between an L1's miss and its fill, and the stamps that tell them
// apart.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "base/stats.h"
#include "base/types.h"

namespace glint::mem {

// In the order in which a read passes them. The queues take no time when nothing else is on the way.
enum class Stage : uint8_t {
  L1Queue,      // accepted by the L1 -> its packet starts to leave: tags, miss queue, request port
  Request,      // -> all of it has come to the partition
  L2Queue,      // -> the slice serves it: those before it, and MSHRs, merges and places that are missing
  L2Service,    // -> the slice's answer, or the miss goes on
  DramWay,      // -> the DRAM scheduler could see it
  DramQueue,    // -> its column command: those before it, and rows that are opened for it
  DramService,  // -> its last data is there
  Reply,        // -> the L1 has filled it in: reply ports, the way back, the fill port
  Count
};
constexpr std::string_view name_of(Stage stage) {
  constexpr std::string_view kNames[] = {"l1_queue", "request",    "l2_queue",     "l2_service",
                                         "dram_way", "dram_queue", "dram_service", "reply"};
  static_assert(std::size(kNames) == size_t(Stage::Count));
  return kNames[size_t(stage)];
}

// When each stage but the last ended. Modulo 2^32: only differences are used, and no miss takes that long.
struct Stamps {
  std::array<uint32_t, size_t(Stage::Count) - 1> end{};
  uint32_t accepted = 0;  // of an atomic by its L1; other reads wait there, and each knows its own
  void set(Stage stage, Cycle cycle) { end[size_t(stage)] = uint32_t(cycle); }
  // From `stage` on up to the reply, all ended at `cycle`: the read goes no further down.
  void set_rest(Stage stage, Cycle cycle) { std::fill(end.begin() + int(stage), end.end(), uint32_t(cycle)); }
};

// Splits [accepted, filled): exactly, whatever the stamps say. Who came when the data was already on its way
// has no part in the stages that were over by then.
inline void add_stages(stats::Breakdown<Stage>& to, Cycle accepted, Cycle filled, const Stamps& stamps) {
  auto left = uint32_t(filled - accepted);  // of the latency, from the stage on
  for (size_t i = 0; i < stamps.end.size(); ++i) {
    const uint32_t after = std::min(left, uint32_t(filled) - stamps.end[i]);
    to.add(Stage(i), left - after);
    left = after;
  }
  to.add(Stage::Reply, left);
}

}  // namespace glint::mem
