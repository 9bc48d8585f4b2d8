// Splits the time of a miss into stages, from the miss of an L1 to its fill, by the stamps between them.
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

// A read passes the stages in this order. Each begins where the one before ends. The comment of a stage names
// its end and, after a colon, what takes its time. The queues take no time when nothing else is in flight.
enum class Stage : uint8_t {
  L1Queue,    // from acceptance by the L1 until the packet starts to leave: tags, miss queue, request port
  Request,    // until the whole packet has come to the slice
  L2Queue,    // until the slice serves it: other packets, and MSHRs, merges or queue entries that are missing
  L2Service,  // until the slice's answer, or until the miss leaves the slice
  DramWay,    // until the DRAM scheduler can see it
  DramQueue,  // until its column command: other requests, and the row that is opened for it
  DramService,  // until its last data are there
  Reply,        // until the L1 has filled the data in: reply ports, the way back, the fill port
  Count
};
constexpr std::string_view name_of(Stage stage) {
  constexpr std::string_view kNames[] = {"l1_queue", "request",    "l2_queue",     "l2_service",
                                         "dram_way", "dram_queue", "dram_service", "reply"};
  static_assert(std::size(kNames) == size_t(Stage::Count));
  return kNames[size_t(stage)];
}

// Holds the cycle in which each stage but the last ended, modulo 2^32: only differences are used, and no miss
// takes that long.
struct Stamps {
  std::array<uint32_t, size_t(Stage::Count) - 1> end{};
  // Holds when the L1 accepted an atomic. Other reads wait in the L1, which knows their cycle.
  uint32_t accepted = 0;
  void set(Stage stage, Cycle cycle) { end[size_t(stage)] = uint32_t(cycle); }
  // Lets all stages from `stage` up to the reply end at `cycle`, because the read goes no further down.
  void set_rest(Stage stage, Cycle cycle) { std::fill(end.begin() + int(stage), end.end(), uint32_t(cycle)); }
};

// Splits [accepted, filled) into stages; the parts add up exactly. A read that came when the data were
// already on their way has no part in the stages that were over by then.
inline void add_stages(stats::Breakdown<Stage>& to, Cycle accepted, Cycle filled, const Stamps& stamps) {
  auto left = uint32_t(filled - accepted);  // cycles that the stages from this one on share
  for (size_t i = 0; i < stamps.end.size(); ++i) {
    const uint32_t after = std::min(left, uint32_t(filled) - stamps.end[i]);
    to.add(Stage(i), left - after);
    left = after;
  }
  to.add(Stage::Reply, left);
}

}  // namespace glint::mem
