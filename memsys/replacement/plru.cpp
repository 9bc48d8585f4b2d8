// Implements the replacement policy `plru`: a binary tree of bits over the ways points at a line that was not
// used lately.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <vector>

#include "base/registry.h"
#include "memsys/replacement.h"

namespace glint::mem {
namespace {

// Each node of the tree has a bit that names the half that makes way next. An access turns the bits on the
// way to its line to the other half. An unused slot is taken first. A half that has only held lines is passed
// over. The tree spans the number of ways, rounded up to a power of two; slots past the last way do not
// exist.
class TreePlru final : public Replacement {
 public:
  static constexpr const char* kName = "plru";
  static constexpr const char* kDoc =
      "A tree of one bit for each pair of halves approximates the least recently used line (pseudo-LRU).";
  struct Params {
    static ParamList params() { return {}; }
  };

  TreePlru(const Params&, const Context& context)
      : ways_(context.ways), leaves_(std::bit_ceil(context.ways)), upper_(size_t{context.sets} * leaves_) {}

  uint32_t victim(uint32_t set, std::span<const CacheLine> lines) const override {
    const uint32_t first = set * ways_;
    if (const uint32_t unused = first_unused(lines, first, ways_); unused != kNone) return unused;
    const uint32_t way = descend(set, 1, lines.subspan(first, ways_));
    return way == kNone ? kNone : first + way;
  }
  void filled(uint32_t slot) override { touched(slot); }
  void touched(uint32_t slot) override {
    const uint32_t set = slot / ways_;
    for (uint32_t node = leaves_ + slot % ways_; node > 1; node /= 2)
      upper_[size_t{set} * leaves_ + node / 2] = node % 2 == 0;
  }

 private:
  // Returns the number of the way below `node` whose line makes way, or kNone. Node 1 is the root, the
  // children of node n are 2n and 2n + 1, and node leaves_ + w is way w.
  uint32_t descend(uint32_t set, uint32_t node, std::span<const CacheLine> ways) const {
    if (node >= leaves_) {
      const uint32_t way = node - leaves_;
      return way >= ways_ || ways[way].held ? kNone : way;
    }
    const uint32_t next = 2 * node + upper_[size_t{set} * leaves_ + node];
    const uint32_t way = descend(set, next, ways);
    return way != kNone ? way : descend(set, next ^ 1, ways);
  }

  const uint32_t ways_, leaves_;
  std::vector<uint8_t> upper_;  // whether the upper half makes way next, by set and node
};

const Register<Replacement, TreePlru> registered;

}  // namespace
}  // namespace glint::mem
