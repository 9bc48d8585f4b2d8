// Walks the control flow of programs backwards from where lanes end.
// SPDX-License-Identifier: Apache-2.0
#include "exec/endless_loops.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <fmt/format.h>
#include <map>
#include <utility>

#include "exec/launch.h"
#include "isa/effects.h"
#include "isa/op_row.h"
#include "isa/verify_flow.h"

namespace glint::exec {
namespace {

isa::Effect effect_at(const isa::Program& program, uint32_t at) {
  return isa::op_table()[program.code[at].op].effect;
}

// Returns whether lanes may go no further than this instruction.
bool may_end(isa::Effect effect) {
  const isa::Flow flow = isa::effect_row(effect).flow;
  return flow == isa::Flow::Return || flow == isa::Flow::Exit || flow == isa::Flow::Trap;
}

// Returns for each instruction whether a lane at it can come to an instruction of `ends`. With `into_calls`
// it may come there inside of a called function, too.
template <class Ends>
std::vector<uint8_t> reaching(const isa::Program& program, bool into_calls, Ends ends) {
  const uint32_t size = uint32_t(program.code.size());
  std::vector<std::vector<uint32_t>> before(size);
  std::vector<uint8_t> out(size);
  std::vector<uint32_t> pending;
  for (uint32_t at = 0; at < size; ++at) {
    const isa::Effect effect = effect_at(program, at);
    std::vector<uint32_t> next = isa::successors(program, at);
    if (effect == isa::Effect::Call && !into_calls) next.erase(next.begin());
    for (const uint32_t to : next)
      if (to < size) before[to].push_back(at);
    if (ends(effect)) out[at] = 1, pending.push_back(at);
  }
  while (!pending.empty()) {
    const uint32_t at = pending.back();
    pending.pop_back();
    for (const uint32_t from : before[at])
      if (!out[from]) out[from] = 1, pending.push_back(from);
  }
  return out;
}

// Without a jump back there is no loop, and nothing to look for.
bool jumps_back(const isa::Program& program) {
  for (uint32_t at = 0; at < program.code.size(); ++at)
    if (effect_at(program, at) == isa::Effect::Branch && uint32_t(program.code[at].imm) <= at) return true;
  return false;
}

// Says which lines, or else instructions, lie from `first` to `last`.
std::string span_text(const Image& image, uint32_t first, uint32_t last) {
  uint32_t low = image.lines[first].line, high = low;
  for (uint32_t pc = first; pc <= last; ++pc) {
    if (image.lines[pc].file != image.lines[first].file || !image.lines[pc].line) continue;
    low = std::min(low, image.lines[pc].line);
    high = std::max(high, image.lines[pc].line);
  }
  const uint32_t entry = image.shaders[image.shader_of[first]].entry;
  if (low == 0 && first == last) return fmt::format("the loop of instruction {}", first - entry);
  if (low == 0) return fmt::format("the loop of instructions {} to {}", first - entry, last - entry);
  return low == high ? fmt::format("the loop of line {}", low)
                     : fmt::format("the loop of lines {} to {}", low, high);
}

// Returns first and last instruction of the loops around an instruction, the innermost first. A loop reaches
// from the target of a jump back to the last such jump.
std::vector<std::pair<uint32_t, uint32_t>> loops_of(const Image& image, uint32_t pc) {
  std::vector<std::pair<uint32_t, uint32_t>> out;
  for (uint32_t from = pc; from < image.code.size() && image.shader_of[from] == image.shader_of[pc]; ++from) {
    if (image.code[from].effect != isa::Effect::Branch) continue;
    const uint32_t to = uint32_t(image.code[from].inst.imm);
    if (to > pc) continue;
    const auto same =
        std::find_if(out.begin(), out.end(), [&](const auto& loop) { return loop.first == to; });
    if (same != out.end())
      same->second = from;
    else
      out.emplace_back(to, from);
  }
  std::ranges::sort(out,
                    [](const auto& a, const auto& b) { return a.second - a.first < b.second - b.first; });
  return out;
}

}  // namespace

EndlessLoops::EndlessLoops(const Image& image) {
  std::vector<uint8_t> found(image.code.size());
  bool has_any = false;
  for (size_t i = 0; i < image.programs.size(); ++i) {
    const isa::Program& program = image.programs[i];
    if (!jumps_back(program)) continue;
    // A function that returns does not end its caller, and a function that exits does.
    const std::vector<uint8_t> returns = reaching(program, false, may_end);
    const std::vector<uint8_t> exits = reaching(
        program, true, [](isa::Effect effect) { return may_end(effect) && effect != isa::Effect::Return; });
    const auto is_endless = [&](uint32_t at) { return !returns[at] && !exits[at]; };
    for (uint32_t from = 0; from < program.code.size(); ++from) {
      if (effect_at(program, from) != isa::Effect::Branch || !is_endless(from)) continue;
      // What only leads to the loop is left out.
      for (uint32_t at = uint32_t(program.code[from].imm); at <= from; ++at)
        if (is_endless(at)) found[image.shaders[i].entry + at] = 1, has_any = true;
    }
  }
  if (has_any) is_in_ = std::move(found);
}

Fault EndlessLoops::fault(const World& world, const WarpContext& warp) const {
  const Image& image = *world.image;
  const std::vector<std::pair<uint32_t, uint32_t>> loops = loops_of(image, warp.simt.pc);
  // The outermost loop that nothing leads out of is the one to mend.
  std::pair<uint32_t, uint32_t> endless{warp.simt.pc, warp.simt.pc};
  for (const auto& loop : loops)
    if (holds(loop.first)) endless = loop;
  const int lane = warp.simt.active ? std::countr_zero(warp.simt.active) : 0;
  return {fmt::format("no end in sight: nothing leads out of {}, which the warp has entered",
                      span_text(image, endless.first, endless.second)),
          image.place_of(endless.first), shader_thread_id(warp, lane)};
}

std::string loops_around(const Image& image, uint32_t pc) {
  std::string out;
  for (const auto& [first, last] : loops_of(image, pc))
    out += fmt::format("{}{}", out.empty() ? "in " : ", which is in ", span_text(image, first, last));
  return out;
}

std::optional<BusiestLine> busiest_line(const Image& image, std::span<const uint32_t> pcs) {
  std::map<std::string, BusiestLine> lines;
  for (const uint32_t pc : pcs) {
    BusiestLine& line = lines[image.line_of(pc)];
    line.pc = line.num_warps == 0 ? pc : std::min(line.pc, pc);
    ++line.num_warps;
  }
  if (lines.empty()) return {};
  const auto most = std::max_element(lines.begin(), lines.end(), [](const auto& a, const auto& b) {
    return a.second.num_warps != b.second.num_warps ? a.second.num_warps < b.second.num_warps
                                                    : a.second.pc > b.second.pc;
  });
  return BusiestLine{most->first, most->second.pc, most->second.num_warps, pcs.size()};
}

std::string BusiestLine::to_string(const Image& image) const {
  const std::string loops = loops_around(image, pc);
  return fmt::format("{} of {} running warps are at {}{}{}", num_warps, of, place, loops.empty() ? "" : ", ",
                     loops);
}

}  // namespace glint::exec
