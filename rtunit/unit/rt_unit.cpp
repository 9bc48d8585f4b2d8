// Makes the parts of an RT unit, and runs a cycle of it from the back of the pipeline to its front.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/rt_unit.h"

#include <algorithm>
#include <concepts>
#include <string>
#include <utility>

#include "base/check.h"
#include "rtunit/shortcuts/hit_stores.h"
#include "rtunit/shortcuts/split_reads.h"
#include "rtunit/unit/entry_look_up.h"
#include "rtunit/unit/leaf_look_ups.h"
#include "rtunit/unit/path_keeper.h"
#include "rtunit/unit/result_writer.h"
#include "rtunit/unit/stack_mover.h"
#include "rtunit/unit/table_writer.h"
#include "rtunit/unit/walk_order.h"

namespace glint::rt {
namespace {

bool has_pool(const Params& params) {
  return params.pool.name != RayPool::kNone;
}

}  // namespace

uint64_t RtUnit::result_bytes(const Params& params) {
  if (params.shortcuts.store_each_hit) return HitStores::kBytes;
  return params.result_store ? ResultWriter::bytes(params) : 0;
}

uint64_t RtUnit::stack_bytes_per_warp(const Params& params) {
  return StackMover::bytes_per_warp(*params.stack.make({}));
}

uint32_t RtUnit::shared_bytes_per_warp(const Params& params) {
  return params.stack.make({})->shared_area().bytes_per_warp();
}

uint64_t RtUnit::pool_bytes(const Params& params) {
  return has_pool(params) ? WarpFormer::bytes(params) : 0;
}

uint32_t RtUnit::places(const Params& params) {
  return has_pool(params) ? params.pool_warps : params.slots();
}

RtUnit::RtUnit(const Params& params, const Context& context)
    : requests_per_cycle_(params.requests_per_cycle),
      l1_(context.l1),
      stats_(context.stats),
      buffer_(params, stats_),
      walk_(params, context.memory, buffer_, stats_),
      pipelines_(params, context.memory, walk_),
      fetches_(params, context.memory, context.l1, buffer_, stats_),
      account_(stats_) {
  add_optional_parts(params, context);
  has_parts_ = former_ || prefetches_ || sharing_ || shared_stacks_ || !sources_.empty() ||
               !before_tests_.empty() || !after_requests_.empty();
  set_due(kNever);
  tell_core();
}

// The order of these lines decides who sends first, which hook is asked first and which exit a warp passes
// first.
void RtUnit::add_optional_parts(const Params& params, const Context& context) {
  const Shortcuts& shortcuts = params.shortcuts;
  const bool has_tables = context.tables.rows != 0;
  if (shortcuts.store_each_hit) {
    HitStores& stores =
        add<HitStores>(shortcuts.store_latency, context.l1, buffer_, stats_, context.results, has_tables);
    before_tests_.push_back([&stores](Cycle now) { stores.acknowledge(now); });
  }
  if (has_pool(params))
    former_ = &add<WarpFormer>(params, context.memory, context.ray_states, context.l1, buffer_, fetches_,
                               walk_, stats_);
  if (params.leaf_filter.name != LeafFilter::kNone)
    add<LeafLookUps>(params.leaf_filter.make({&stats_, context.memory}), buffer_);
  if (params.order.name != TraversalOrder::kDepthFirst)
    add<WalkOrder>(params.order.make({&stats_, context.memory}), context.memory, &stats_);
  auto stack = params.stack.make({});
  std::unique_ptr<RayEntry> entry;
  if (params.entry.name != RayEntry::kRoot) entry = params.entry.make({&stats_, context.memory});
  if (stack->keeps_path() || (entry && entry->wants_path())) add<PathKeeper>(buffer_);
  if (entry) {
    const auto& look_up = add<EntryLookUp>(std::move(entry), context.memory, buffer_, pipelines_, stats_);
    if (former_) former_->set_look_up(look_up);
  }
  if (StackMover::is_needed(*stack)) add_stack_mover(std::move(stack), context);
  if (shortcuts.fetch_headers || shortcuts.fetch_descriptors)
    add<SplitReads>(shortcuts, context.memory, buffer_, pipelines_, stats_);
  if (params.result_store) add<ResultWriter>(context.l1, buffer_, stats_, context.results);
  if (has_tables && !shortcuts.store_each_hit) add<TableWriter>(context.l1, buffer_, stats_, context.tables);
  if (params.prefetch.name != Prefetcher::kNone) {
    prefetches_ = &add<PrefetchSender>(params, context.memory, context.l1, buffer_, stats_);
    fetches_.set_listener(*prefetches_);
  }
  if (params.mapping.name != WorkMapping::kOwnRay)
    sharing_ = &add<WorkSharing>(params, context.memory, buffer_, walk_, stats_);
  if (former_) walk_.add(former_->taker());
  if (shortcuts.same_cycle_hits)
    after_requests_.push_back([this](Cycle now) {
      receive(now);
      pipelines_.start_tests(now);
    });
}

void RtUnit::add_stack_mover(std::unique_ptr<StackModel> model, const Context& context) {
  StackMover& mover =
      add<StackMover>(std::move(model), context.stacks, context.l1, buffer_, fetches_, walk_, stats_);
  if (!mover.has_shared()) return;
  shared_stacks_ = &mover;
  before_tests_.push_back([&mover](Cycle now) { mover.move_shared(now); });
}

template <class Part, class... Args>
Part& RtUnit::add(Args&&... args) {
  const auto part = std::make_shared<Part>(std::forward<Args>(args)...);
  parts_.push_back(part);
  if constexpr (std::derived_from<Part, WalkHook>) walk_.add(*part);
  if constexpr (std::derived_from<Part, RequestSource>) sources_.push_back(part.get());
  if constexpr (std::derived_from<Part, WarpExit>) buffer_.add(*part);
  return *part;
}

void RtUnit::submit(Cycle now, uint32_t warp_slot, LaneMask mask, RayState* states) {
  GLINT_CHECK(can_accept() && mask != 0, "warp {} submitted to a full RT unit or without rays", warp_slot);
  set_due(0);  // The unit looks at the warp in its next cycle.
  ++stats_.warps;
  if (former_) {
    former_->accept(now, warp_slot, mask, states);
  } else {
    const uint32_t slot = buffer_.admit(now, warp_slot, mask, states);
    for_each_lane(mask, [&](int lane) { walk_.start(slot, lane, now); });
  }
  tell_core();
}

std::optional<uint32_t> RtUnit::pop_completion(Cycle now) {
  const auto warp_slot = former_ ? former_->pop_completion(now) : buffer_.pop_completion();
  tell_core();
  return warp_slot;
}

// Notes for the core whether there is room and whether a warp may go back. A pool knows the latter only when
// it is asked.
void RtUnit::tell_core() {
  set_room(former_ ? former_->has_room() : buffer_.has_room());
  set_completion(former_ || buffer_.has_completion());
}

template <bool kHasParts>
void RtUnit::run(Cycle now) {
  buffer_.retire(now);
  if constexpr (kHasParts) {
    if (former_) former_->form(now);
    for (const auto& step : before_tests_) step(now);
  }
  pipelines_.finish_tests(now);
  receive(now);
  pipelines_.start_tests(now);
  if constexpr (kHasParts)
    if (sharing_) sharing_->share(now);
  std::optional<Stall> reason = send_requests<kHasParts>(now);
  if constexpr (kHasParts) {
    if (!reason) reason = idle_reason();
    for (const auto& step : after_requests_) step(now);
  }
  const Stall idle = idle_reason();
  account_.account(now, reason.value_or(idle), idle, {buffer_.num_resident(), buffer_.num_rays()});
  set_due(buffer_.take_opened() ? now + 1 : find_due<kHasParts>(now));
  tell_core();
}
template void RtUnit::run<false>(Cycle);
template void RtUnit::run<true>(Cycle);

// Passes what has arrived to the pipelines. A part of a stack needs no test.
inline void RtUnit::receive(Cycle now) {
  fetches_.receive(now, [&](const Read& read, uint32_t slot, LaneMask lanes) {
    if (read.pipe == kNoPipe) [[unlikely]]
      for_each_lane(lanes, [&](int lane) { walk_.go_on(slot, lane, now); });
    else
      pipelines_.push(read, slot, lanes);
  });
}

// Sends as many requests as the port takes in a cycle. Returns the reason that this gives the cycle, or none
// when there is nothing to send.
template <bool kHasParts>
inline std::optional<Stall> RtUnit::send_requests(Cycle now) {
  bool sent = false;
  for (uint32_t i = 0; i < requests_per_cycle_; ++i) {
    bool is_taken;
    if constexpr (kHasParts) {
      RequestSource* source = next_source(now);
      if (!source) break;
      is_taken = source->send(now);
    } else {
      if (!fetches_.has_request(now) && !fetches_.choose(now)) break;
      is_taken = fetches_.send(now);
    }
    if (!is_taken) {
      ++stats_.refusals;
      return sent ? Stall::NodeRequest : Stall::L1Refused;
    }
    sent = true;
  }
  if (sent) return Stall::NodeRequest;
  if constexpr (kHasParts)
    if (prefetches_ && prefetches_->send(now)) return Stall::Prefetch;
  return std::nullopt;
}

// A node whose reading has begun is read to its end. Then writers come before new nodes, so that a finished
// warp does not wait for the nodes of others.
RequestSource* RtUnit::next_source(Cycle now) {
  if (fetches_.has_request(now)) return &fetches_;
  for (RequestSource* source : sources_)
    if (source->has_request(now)) return source;
  return fetches_.choose(now) ? &fetches_ : nullptr;
}

template <bool kHasParts>
inline Cycle RtUnit::find_due(Cycle now) const {
  if (buffer_.has_leaving_warps()) return now + 1;
  Cycle next = std::min(fetches_.next_event(now), pipelines_.next_event());
  if constexpr (kHasParts) {
    for (const RequestSource* source : sources_) next = std::min(next, source->next_event(now));
    if (prefetches_) next = std::min(next, prefetches_->next_event(now));
    if (sharing_) next = std::min(next, sharing_->next_event(now));
  }
  return next == kNever ? next : std::max(next, now + 1);
}

bool RtUnit::has_reads_waiting() const {
  return fetches_.has_reads_waiting() ||
         std::any_of(sources_.begin(), sources_.end(),
                     [](const RequestSource* source) { return source->has_reads_waiting(); });
}

// Returns the reason of a cycle in which nothing is sent.
Stall RtUnit::idle_reason() const {
  if (fetches_.is_full() && has_reads_waiting()) return Stall::MshrFull;
  if (pipelines_.is_any_waiting()) return Stall::TestBusy;
  if (fetches_.num_reads() || (shared_stacks_ && shared_stacks_->has_shared_loads()))
    return Stall::WaitingMemory;
  if (pipelines_.is_any_running()) return Stall::TestLatency;
  return num_resident() ? Stall::Handover : Stall::Idle;
}

}  // namespace glint::rt
