// Follows a counter from its start to its test.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/loop_counter.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "frontend/ptx/constant_words.h"

namespace glint::frontend::ptx {
namespace {

constexpr int64_t kMostTurns = 256;

}  // namespace

bool LoopCounter::find(const VirtualInst& test) {
  if (!row_of(test).name.starts_with("setp.") || test.operands.size() != 3 ||
      body_.keeps(test.operands[0].reg) || !body_.writes_once(test.operands[0].reg))
    return false;
  const VirtualOperand& value = test.operands[1];
  if (!is_register(value) || !body_.step(value.reg)) return false;
  counter_ = value.reg;
  end_ = test.operands[2];
  return is_constant(end_) || (is_register(end_) && !body_.writes(end_.reg));
}

std::optional<uint64_t> LoopCounter::start_of(VirtualRegister r) const {
  BlockId b = at_;
  for (size_t hops = 0; hops < draft_.blocks.size(); ++hops) {
    BlockId before = kNoBlock;
    for (BlockId p = 0; p < draft_.blocks.size(); ++p) {
      const std::vector<BlockId> next = draft_.blocks[p].successors();
      if (p == at_ || std::find(next.begin(), next.end(), b) == next.end()) continue;
      if (before != kNoBlock) return {};
      before = p;
    }
    if (before == kNoBlock) return {};
    b = before;
    const std::vector<VirtualInst>& code = draft_.blocks[b].code;
    for (size_t i = code.size(); i-- > 0;) {
      bool writes = false;
      for_each_def(code[i], [&](VirtualRegister written) { writes |= written == r; });
      if (!writes) continue;
      return ConstantWords().value_of(code[i]);
    }
  }
  return {};
}

std::optional<int64_t> LoopCounter::known_turns(const VirtualInst& last_test) const {
  const std::optional<uint64_t> start = start_of(counter_);
  if (!start || !is_constant(end_)) return {};
  const std::string_view test = row_of(last_test).name;
  const bool is_wide = test.ends_with("64"), is_signed = test.ends_with(".s32") || test.ends_with(".s64");
  if (!is_signed && !test.ends_with(".u32") && !test.ends_with(".u64")) return {};
  const auto extended = [&](uint64_t x) {
    return is_wide ? int64_t(x) : is_signed ? int64_t{int32_t(uint32_t(x))} : int64_t{uint32_t(x)};
  };
  const int64_t end = extended(end_.constant);
  // Counters of 64 bits stay so small that their sign is the same to all tests.
  const auto is_small = [](int64_t x) { return x >= 0 && x < int64_t{1} << 40; };
  if (is_wide && (!is_small(end) || !is_small(int64_t(*start)))) return {};
  for (int64_t turns = 1; turns <= kMostTurns; ++turns) {
    const int64_t value = extended(*start + uint64_t(turns * *body_.step(counter_)));
    if (is_wide && !is_signed && value < 0) return {};
    const std::string_view relation = test.substr(5, 3);
    if (relation == "ne."   ? value == end
        : relation == "eq." ? value != end
        : relation == "lt." ? value >= end
        : relation == "le." ? value > end
        : relation == "gt." ? value <= end
        : relation == "ge." ? value < end
                            : false)
      return turns;
  }
  return {};
}

bool LoopCounter::vanishes(const VirtualInst& inst) const {
  if (inst.op != ops_.add_s32 && inst.op != ops_.add_u32 && inst.op != ops_.add_s64 &&
      inst.op != ops_.add_u64)
    return false;
  return is_register(inst.operands[1]) && body_.step(inst.operands[1].reg) && is_constant(inst.operands[2]);
}

}  // namespace glint::frontend::ptx
