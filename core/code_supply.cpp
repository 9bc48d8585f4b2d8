// Holds a core's caches of instructions and constants, and hands out the lines that warps wait for.
// SPDX-License-Identifier: Apache-2.0
#include "core/code_supply.h"

#include "core/constant_port.h"
#include "core/warp_slots.h"

namespace glint::core {
namespace {

// This is the constant cache's number among the clients of the cache behind. Schedulers have the lower
// numbers.
constexpr uint32_t kConstantClient = kMaxSchedulers;

}  // namespace

std::unique_ptr<CodeSupply> CodeSupply::make(const Params& params, const exec::World& world,
                                             const CodePlaces& places, mem::L1Port& l1,
                                             stats::Group* parent) {
  if (params.fetch.perfect && params.constant.perfect) return nullptr;
  return std::make_unique<CodeSupply>(params, world, places, l1, parent);
}

CodeSupply::CodeSupply(const Params& params, const exec::World& world, const CodePlaces& places,
                       mem::L1Port& l1, stats::Group* parent)
    : stats_(parent),
      cache_(params.code_cache, InstructionFetch::most_in_flight(params.schedulers) + ConstantCache::kMost,
             l1, stats_) {
  if (!params.fetch.perfect)
    fetch_ = std::make_unique<InstructionFetch>(params.fetch, params.schedulers, places.code,
                                                world.image->code.size(), cache_, stats_);
  if (!params.constant.perfect)
    constants_ = std::make_unique<ConstantCache>(params.constant, places.constants,
                                                 world.constant_bank.size(), kConstantClient, cache_, stats_);
}

void CodeSupply::tick(Cycle now, WarpSlots& warps, ConstantPort& constants) {
  cache_.tick(now);
  for (const CodeCache::Answer& answer : cache_.answers()) {
    if (answer.client == kConstantClient) {
      constants.take_line(answer.line, now);
    } else if (const uint32_t line = fetch_->arrive(answer.client, answer.line);
               line != InstructionFetch::kNone) {
      warps.take_line(answer.client, line, now);
    }
  }
}

}  // namespace glint::core
