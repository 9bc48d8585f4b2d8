// Drives a MemorySystem as an engine would, for tests: windows, delivery, skipping or stepping.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "memsys/memory_system.h"

namespace glint::mem {

// Returns the struct's defaults without what the presets leave off. A test turns on what it is about.
inline Params bare() {
  Params p;
  p.l1.fill_takes_access = p.l2.fill_takes_service = p.l2.write_masks = false;
  p.noc.credits = 0;
  p.dram.refresh = "none";
  return p;
}

// Holds one token that came back.
struct Answered {
  Cycle at = 0;
  uint32_t core = 0;
  Client client = Client::Lsu;
  Token token = 0;
  bool operator==(const Answered&) const = default;
};

// Does what a core does in a cycle: tries to access. It runs in every cycle in which it may have something to
// do.
class MemoryRig {
 public:
  explicit MemoryRig(const Params& params, uint32_t cores = 1, double core_mhz = 1000.0)
      : root_(nullptr, "test"),
        memory_(params, cores, core_mhz, &root_),
        cells_(memory_.cells()),
        channels_(memory_.channels()) {
    window_ = memory_.shortest_latency();
  }
  void set_window(Cycle window) { window_ = window; }
  void set_step_every_cycle(bool step) { step_ = step; }
  // Lets an L1 have its tick() only when it is due, as a core does.
  void set_tick_when_due(bool when_due) { when_due_ = when_due; }

  // Is called for each core and cycle after tick(). Returns the next cycle at which it wants to be called, or
  // kNever when it is done.
  using Driver = std::function<Cycle(uint32_t core, Cycle now)>;

  // Runs until nothing is in flight and every driver is done. Answers are collected in canonical order.
  void run(const Driver& driver) {
    std::vector<Cycle> wanted(memory_.num_cores(), now_);
    for (;;) {
      for (ChannelBase* channel : channels_) channel->deliver();
      Cycle next = *std::min_element(wanted.begin(), wanted.end());
      for (ChannelBase* channel : channels_) next = std::min(next, channel->next_arrival());
      for (Cell* cell : cells_) next = std::min(next, cell->next_event(now_));
      for (uint32_t c = 0; c < memory_.num_cores(); ++c)
        next = std::min(next, memory_.l1(c).next_event(now_));
      if (next == kNever) break;
      const Cycle from = step_ ? now_ : std::max(next, now_);
      const Cycle until = from + window_;
      for (uint32_t c = 0; c < memory_.num_cores(); ++c) advance_core(c, from, until, wanted[c], driver);
      for (Cell* cell : cells_) cell->advance(from, until);
      now_ = until;
    }
    std::stable_sort(answers_.begin(), answers_.end(), [](const Answered& a, const Answered& b) {
      return a.at != b.at ? a.at < b.at : a.core != b.core ? a.core < b.core : a.client < b.client;
    });
  }
  // Runs without any access.
  void drain() {
    run([](uint32_t, Cycle) { return kNever; });
  }
  // Issues one read at `at` (not before now) on an otherwise idle system, and returns the cycle in which its
  // token came back.
  Cycle read_latency(Address line, uint8_t sectors, bool write = false, Traffic traffic = Traffic::RtNode) {
    const Cycle start = now_;
    const size_t before = answers_.size();
    run([&](uint32_t core, Cycle now) {
      if (core == 0 && now == start)
        memory_.l1(0).access(now, Client::Lsu, {line, sectors, write, traffic, 1});
      return kNever;
    });
    return answers_.size() == before ? 0 : answers_.back().at - start;
  }

  MemorySystem& memory() { return memory_; }
  L1Cache& l1(uint32_t core = 0) { return memory_.l1(core); }
  Cycle now() const { return now_; }
  const std::vector<Answered>& answers() const { return answers_; }
  stats::Group& root() { return root_; }

 private:
  void advance_core(uint32_t core, Cycle from, Cycle until, Cycle& wanted, const Driver& driver) {
    L1Cache& l1 = memory_.l1(core);
    for (Cycle now = from; now < until;) {
      if (!step_) now = std::max(now, std::min(wanted, l1.next_event(now)));
      if (now >= until) break;
      if (!when_due_ || l1.is_due(now)) l1.tick(now);
      collect(l1, core, now);
      if (wanted <= now) wanted = driver(core, now);
      collect(l1, core, now);  // what was answered at once
      ++now;
    }
  }
  void collect(L1Cache& l1, uint32_t core, Cycle now) {
    for (const Client client : {Client::Lsu, Client::RtUnit})
      while (const std::optional<Token> token = l1.pop(now, client))
        answers_.push_back({now, core, client, *token});
  }

  stats::Group root_;
  MemorySystem memory_;
  std::vector<Cell*> cells_;
  std::vector<ChannelBase*> channels_;
  Cycle window_ = 1, now_ = 0;
  bool step_ = false, when_due_ = false;
  std::vector<Answered> answers_;
};

}  // namespace glint::mem
