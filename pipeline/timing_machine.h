// Runs the timing machine cycle by cycle over one launch: cores with their L1 and RT unit, and the memory
// system.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/stats.h"
#include "core/core_cell.h"
#include "core/dispatcher.h"
#include "engine/engine_loop.h"
#include "exec/endless_loops.h"
#include "memsys/memory_system.h"
#include "pipeline/launch_part.h"
#include "pipeline/progress_watch.h"
#include "pipeline/render.h"
#include "rtunit/unit/rt_unit.h"

namespace glint::pipeline {

// Says how the host runs the machine. No result depends on it (engine_loop.h).
struct HostOptions {
  uint32_t threads = 1;  // 0: as many as the host has processors, while they are faster than one
  Cycle window = 0;      // 0: the longest possible window
  // These are the threads of the cells, cores first and then partitions. When the list is empty, cells go to
  // threads in turn.
  std::vector<uint32_t> homes{};
};

// Holds physical memory that a machine has reserved for a launch, until the launch has ended.
class Reserves {
 public:
  explicit Reserves(mem::AddressSpace& memory) : memory_(memory) {}
  Reserves(const Reserves&) = delete;
  Reserves& operator=(const Reserves&) = delete;
  ~Reserves() { give_back(); }
  Address take(uint64_t bytes);
  // Gives everything back. The memory may end after it.
  void give_back();

 private:
  mem::AddressSpace& memory_;
  std::vector<std::pair<Address, uint64_t>> all_;
};

// Returns whether the launch has instructions that trace rays.
bool traces_rays(const exec::World& world);

// Returns how many blocks and warps of the launch fit on a core.
core::Residency residency_of(const GpuParams& params, const exec::World& world);

// Builds the whole GPU for one launch. `world` outlives the launch. Device runs one launch after another.
class TimingMachine {
 public:
  // Throws UserError that lists every impossible parameter.
  TimingMachine(const GpuParams& params, const exec::World& world, bool no_skip,
                const HostOptions& host = {});

  // Runs the launch to its end, or until the watch ends it, and returns its cycles. Throws as render() does.
  // The memory that it has reserved is free again afterwards.
  // With `part`, only the blocks run that it names.
  Cycle run(const LaunchWatch& watch, LaunchPart* part = nullptr);
  LaunchEnd end() const { return end_; }                        // why run() has ended
  const LaunchProgress& progress() const { return progress_; }  // how far it came, if the watch has ended it

  // Returns what the cycles of every unit add up to after run().
  Cycle attributed_cycles() const { return root_.attributed.value(); }

  // Returns the faults of all cores that were let pass.
  exec::FaultLog passed() const;

  // Returns the stores of texels that were not finite, of all cores.
  exec::NotFiniteStores not_finite_stores() const;

  // Sums over the cores for the caller's result.
  void collect(RenderResult& result) const;

  const GpuParams& params() const { return params_; }
  const stats::Group& root() const { return root_; }
  stats::Group& root() { return root_; }
  const core::CoreCell& core(uint32_t index) const { return *cores_[index]; }
  core::CoreCell& core(uint32_t index) { return *cores_[index]; }
  const rt::RtUnit& rt_unit(uint32_t index) const { return *rt_units_[index]; }
  rt::RtUnit& rt_unit(uint32_t index) { return *rt_units_[index]; }
  const mem::MemorySystem& memory() const { return memory_; }
  mem::MemorySystem& memory() { return memory_; }
  uint32_t num_cores() const { return uint32_t(cores_.size()); }

 private:
  // Says what the cores have done in the last turn that concerns others.
  struct News {
    bool memory_changed = false, has_room = false;
    const exec::Fault* fault = nullptr;  // of the first core that has one
  };
  News commit_effects();
  void connect();
  void connect_issue_policy(uint32_t i);
  void refuse_livelock(Cycle now, bool memory_changed);
  void refuse_endless_launch(Cycle now);
  void refuse_endless_loops() const;
  std::optional<exec::BusiestLine> busiest_line() const;
  uint64_t instructions() const;
  void finish(Cycle quiet, Cycle cycles);

  struct Root : stats::Group {
    Root() : Group(nullptr, "gpu") {}
    stats::Counter cycles{
        this, "cycles", "cycle",
        "Cycles from the launch to the end of the last core, which is the time of the launch."};
    stats::Counter attributed{this, "attributed_cycles", "cycle",
                              "Cycles from the launch to the last write in memory, in whole windows. The "
                              "cycles of every unit add up to this number."};
    stats::Breakdown<exec::FaultKind> faults{this, "faults", "fault", exec::kFaultsDoc};
  };

  const GpuParams params_;
  const exec::World& world_;
  Reserves reserves_;
  Root root_;
  mem::LatencyStats access_latency_{&root_, "access_latency",
                                    "Number of warp instructions that read memory through the L1, by traffic "
                                    "class. Their latency lasts from the issue to the last sector."};
  mem::MemorySystem memory_;
  std::vector<std::unique_ptr<stats::Group>> rt_groups_;
  std::vector<std::unique_ptr<rt::RtUnit>> rt_units_;
  std::vector<std::unique_ptr<core::CoreCell>> cores_;
  // These are the cores' bytes of news, in cache lines of their own.
  struct alignas(64) NewsLine {
    std::array<uint8_t, 64> bytes{};
  };
  std::vector<NewsLine> news_lines_;
  std::vector<exec::MemoryView*> views_;  // those of the cores that have effects, while these are committed
  const exec::EndlessLoops endless_;
  ProgressWatch effects_, turnover_;
  LaunchEnd end_ = LaunchEnd::Whole;
  LaunchProgress progress_;
  EngineLoop engine_;
};

}  // namespace glint::pipeline
