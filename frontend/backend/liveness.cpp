// Computes liveness by backward dataflow over bit sets, and finds call regions by following control flow from
// each SaveLive.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/liveness.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "frontend/backend/slots.h"

namespace glint::frontend {

bool LiveWalk::is_conditional(VirtualRegister r) const {
  return std::any_of(conditional_.begin(), conditional_.end(),
                     [&](const Conditional& c) { return c.reg == r; });
}

bool LiveWalk::is_conditional(VirtualRegister r, const VirtualInst& inst) const {
  return std::any_of(conditional_.begin(), conditional_.end(), [&](const Conditional& c) {
    return c.reg == r && c.guard == inst.guard && c.negate == inst.guard_negate;
  });
}

void LiveWalk::forget(VirtualRegister r) {
  std::erase_if(conditional_, [&](const Conditional& c) { return c.reg == r || c.guard == r; });
}

void LiveWalk::step(const VirtualInst& inst) {
  for_each_def(inst, [&](VirtualRegister r) {
    if (!is_guarded(inst) || is_conditional(r, inst)) {
      live_.erase(r);
      forget(r);
    } else if (live_.contains(r) && !is_conditional(r)) {
      conditional_.push_back({r, inst.guard, !inst.guard_negate});
    }
    // The guard changes here and was another one before, so reads under it count as reads by all lanes.
    std::erase_if(conditional_, [&](const Conditional& c) { return c.guard == r; });
  });
  for_each_use(inst, [&](VirtualRegister r) {
    if (!live_.contains(r) && is_guarded(inst) && r != inst.guard)
      conditional_.push_back({r, inst.guard, inst.guard_negate});
    else if (!is_guarded(inst) || r == inst.guard || !is_conditional(r, inst))
      std::erase_if(conditional_, [&](const Conditional& c) { return c.reg == r; });
    live_.insert(r);
  });
}

Liveness find_liveness(const VirtualProgram& program) {
  const size_t blocks = program.blocks.size();
  Liveness out;
  out.in.assign(blocks, RegisterSet(program.registers.size()));
  out.out = out.in;
  std::vector<bool> walked(blocks);
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t b = blocks; b-- > 0;) {
      const VirtualBlock& block = program.blocks[b];
      bool grew = false;
      for (BlockId next : block.successors) grew |= out.out[b].unite(out.in[next]);
      if (walked[b] && !grew) continue;
      walked[b] = true;
      LiveWalk walk(out.out[b]);
      for (size_t i = block.code.size(); i-- > 0;) walk.step(block.code[i]);
      changed |= out.in[b].unite(walk.live());
    }
  }
  return out;
}

std::vector<float> block_weights(const VirtualProgram& program) {
  constexpr float kTripsOfALoop = 8.0f;  // Choice: unknown trip counts count as 8.
  constexpr float kMost = 8.0f * 8.0f * 8.0f * 8.0f;
  std::vector<float> weights(program.blocks.size(), 1.0f);
  // Holds the last block of the loop that a block heads.
  std::vector<BlockId> last_latch(program.blocks.size(), kNoBlock);
  for (BlockId b = 0; b < program.blocks.size(); ++b)
    for (BlockId next : program.blocks[b].successors)
      if (next <= b) last_latch[next] = b;
  for (BlockId head = 0; head < program.blocks.size(); ++head) {
    if (last_latch[head] == kNoBlock) continue;
    for (BlockId b = head; b <= last_latch[head]; ++b)
      weights[b] = std::min(weights[b] * kTripsOfALoop, kMost);
  }
  return weights;
}

std::vector<bool> enters_in_region(const VirtualProgram& program) {
  enum : char { kUnknown, kOutside, kInside };
  std::vector<char> state(program.blocks.size(), kUnknown);
  std::vector<BlockId> work{0};
  if (!program.blocks.empty()) state[0] = kOutside;
  while (!work.empty() && !program.blocks.empty()) {
    const BlockId b = work.back();
    work.pop_back();
    char now = state[b];
    for (const VirtualInst& inst : program.blocks[b].code) {
      if (inst.kind == VirtualInst::Kind::SaveLive) now = kInside;
      if (inst.kind == VirtualInst::Kind::RestoreLive) now = kOutside;
    }
    for (BlockId next : program.blocks[b].successors) {
      GLINT_CHECK(state[next] == kUnknown || state[next] == now,
                  "'{}': block '{}' lies inside and outside a call region", program.name,
                  program.blocks[next].name);
      if (state[next] != kUnknown) continue;
      state[next] = now;
      work.push_back(next);
    }
  }
  std::vector<bool> inside(program.blocks.size());
  for (size_t b = 0; b < inside.size(); ++b) inside[b] = state[b] == kInside;
  return inside;
}

namespace {

// Returns the RestoreLive that control reaches from a SaveLive. It visits each block between them once.
ProgramPoint find_restore(const VirtualProgram& program, ProgramPoint save) {
  std::vector<bool> seen(program.blocks.size());
  std::vector<ProgramPoint> work{{save.block, save.index + 1}};
  ProgramPoint found;
  while (!work.empty()) {
    const ProgramPoint at = work.back();
    work.pop_back();
    const VirtualBlock& block = program.blocks[at.block];
    const auto restore =
        std::find_if(block.code.begin() + std::ptrdiff_t(at.index), block.code.end(),
                     [](const VirtualInst& inst) { return inst.kind == VirtualInst::Kind::RestoreLive; });
    if (restore != block.code.end()) {
      const ProgramPoint here{at.block, size_t(restore - block.code.begin())};
      GLINT_CHECK(found.block == kNoBlock || found == here, "'{}': a SaveLive reaches two RestoreLive",
                  program.name);
      found = here;
      continue;
    }
    for (BlockId next : block.successors) {
      if (seen[next]) continue;
      seen[next] = true;
      work.push_back({next, 0});
    }
  }
  GLINT_CHECK(found.block != kNoBlock, "'{}': a SaveLive without RestoreLive", program.name);
  return found;
}

RegisterSet live_after(const VirtualProgram& program, const Liveness& liveness, ProgramPoint point) {
  const VirtualBlock& block = program.blocks[point.block];
  LiveWalk walk(liveness.out[point.block]);
  for (size_t i = block.code.size(); i-- > point.index + 1;) walk.step(block.code[i]);
  return walk.live();
}

}  // namespace

std::vector<CallRegion> find_call_regions(const VirtualProgram& program, const Liveness& liveness) {
  std::vector<CallRegion> regions;
  for (BlockId b = 0; b < program.blocks.size(); ++b) {
    for (size_t i = 0; i < program.blocks[b].code.size(); ++i) {
      if (program.blocks[b].code[i].kind != VirtualInst::Kind::SaveLive) continue;
      CallRegion region{{b, i}, find_restore(program, {b, i}), {}};
      region.live = live_after(program, liveness, region.restore);
      region.live.intersect(live_after(program, liveness, region.save));
      regions.push_back(std::move(region));
    }
  }
  return regions;
}

std::vector<CallRegion> find_call_regions(const VirtualProgram& program) {
  for (const VirtualBlock& block : program.blocks)
    for (const VirtualInst& inst : block.code)
      if (inst.kind == VirtualInst::Kind::SaveLive) return find_call_regions(program, find_liveness(program));
  return {};
}

}  // namespace glint::frontend
