// Shows global memory to one core within a turn: its own stores at once, those of other cores from the next
// turn on.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/types.h"
#include "exec/texture_format.h"
#include "isa/op_row.h"

namespace glint::exec {

// Holds what one core does to global memory in a turn. Cores run a turn apart from each other
// (engine/engine_loop.h), so within a turn no core may see what another one does. A core's stores go to
// copies of the lines that they touch and into a list; atomics go only into the list. Between turns, commit()
// does what the lists of all cores say, in order of cycle, then core. So other cores see a store some tens of
// cycles after its issue, which is sooner than it could reach the L2. Everything that happened to memory has
// one order, which does not depend on how the machine is run.
//
// An atomic's old value comes with commit(), and so does a load of bytes that an atomic of the same turn
// changes: their registers are written then. The core ensures that nobody reads these registers before.
// Model: textures, acceleration structures and binding tables are read as they were before the turn.
class MemoryView {
 public:
  static constexpr uint32_t kLine = 64;    // bytes on the host; allocations are aligned to it
  static constexpr uint32_t kWidest = 32;  // bytes of a lane's access

  struct Modify {
    std::byte* at;
    isa::AtomicFunction function;
    uint64_t b, c;
    uint8_t bytes;  // 2, 4 or 8
    uint32_t* to;   // the lane of a row (and of the next row for 8 bytes) for the old value; or null
  };
  struct Load {
    const std::byte* at;
    uint8_t bytes;  // 1, 2 or 4
    bool sign_extend;
    uint32_t* to;
  };
  struct LoadTexel {
    const std::byte* at;
    const isa::OpRow* row;
    TexelFormat format;
    std::array<uint32_t*, 4> to;  // null beyond the results
  };

  // Sets the time of what follows to `now`.
  void begin(Cycle now);
  Cycle now() const { return now_; }
  void store(std::byte* at, const void* from, uint32_t bytes);
  void modify(const Modify& modify);
  void load(const Load& load);  // It takes place with commit().
  void load(const LoadTexel& load);

  // Returns whether commit() has anything to do for this core.
  bool has_effects() const { return !batches_.empty(); }
  // Returns whether this core has written in this turn, so that reads have to ask.
  bool touched() const { return !lines_.empty(); }
  // Returns whether an atomic changes any of the bytes at the turn's end.
  bool waits(const std::byte* at, uint32_t bytes) const;
  // Returns where the bytes can be read: at their place, or in `scratch` when this core has written some of
  // them.
  const std::byte* read(const std::byte* at, uint32_t bytes, std::span<std::byte, kWidest> scratch) const;

  // Ends the turn for all cores of the machine. `views` are those that have effects, in the order of the
  // cores. Returns whether any byte of memory has changed.
  static bool commit(std::span<MemoryView* const> views);

 private:
  struct Line {
    std::byte* place;    // place of its first byte
    uint64_t waits = 0;  // bytes that atomics will change
    std::array<std::byte, kLine> data;
  };
  struct Store {
    std::byte* at;
    uint32_t bytes;
    std::array<std::byte, 16> data;
  };
  // Holds effects of one kind at one time: [first, end) of the kind's list.
  enum class Kind : uint8_t { Store, Modify, Load, LoadTexel };
  struct Batch {
    Cycle at;
    Kind kind;
    uint32_t first, end;
  };

  void note(Kind kind, size_t count);
  Line& line_of(std::byte* place);
  const Line* find(const std::byte* place) const;
  void grow();
  bool run(const Batch& batch) const;
  void clear();

  Cycle now_ = 0;
  std::vector<Batch> batches_;
  std::vector<Store> stores_;
  std::vector<Modify> modifies_;
  std::vector<Load> loads_;
  std::vector<LoadTexel> texels_;
  // Capacities are kept, so that a warm view allocates nothing. A slot holds a line's number + 1, and counts
  // only if it is of this turn.
  struct Slot {
    uint32_t turn = 0, line = 0;
  };
  std::vector<Line> lines_;
  std::vector<Slot> slots_ = std::vector<Slot>(256);
  uint32_t turn_ = 1;
  uint32_t next_ = 0;  // next batch while they are committed
};

// Returns a texel as an image op loads it.
Words load_texel(const isa::OpRow& row, TexelFormat format, const std::byte* at);

}  // namespace glint::exec
