// Runs one op on every lane of two warps, on both machines, and gives back its results and all bytes that it
// can reach.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "exec/image.h"
#include "isa/op_row.h"
#include "pipeline/params.h"

namespace glint::test {

inline constexpr size_t kThreads = 64;  // two warps of one block
// Holds one word of every thread: a source, or a result. Values of 64 bits take two columns, the low half
// first.
using Column = std::array<uint32_t, kThreads>;
using Bytes = std::vector<uint8_t>;

// Holds the contents of every state space, and of the images.
struct Spaces {
  Bytes global, shared, constants;
  std::array<Bytes, kThreads> local;
  std::vector<Bytes> images;
  bool operator==(const Spaces&) const = default;
};

struct Outcome {
  std::vector<Column> results;
  Spaces after;
  uint64_t lanes = 0;   // lanes that executed the op, as the machine's own events say
  std::string fault;    // message of the fault that ended the run, or ""
  std::string printed;  // what the shader printed
};

// Gives random numbers that are the same on every machine (splitmix64).
struct Random {
  uint64_t state = 1;
  uint64_t next();
  uint32_t below(uint32_t end) { return uint32_t(next() >> 32) % end; }
};

class OpLab {
 public:
  static constexpr uint32_t kGlobalBytes = 1024, kSharedBytes = 1024, kLocalBytes = 64;
  static constexpr uint32_t kParamBytes = 64;  // parameters that the program itself uses
  // A result that no lane has written.
  static constexpr uint32_t kUntouched = 0xdead'beef;

  // Writes a program around the op. `displacement` is added to its address. `prelude` stands before it and
  // may use %r100 to %r127, of which the first `num_extra` are columns of run() behind the op's own sources.
  explicit OpLab(const isa::OpRow& row, int32_t displacement = 0, const std::string& prelude = "",
                 uint32_t num_extra = 0);
  OpLab(const OpLab&) = delete;
  OpLab& operator=(const OpLab&) = delete;

  // Returns the number of words that the op's sources take, and its results.
  size_t num_sources() const { return num_sources_; }
  size_t num_results() const { return num_results_; }
  Address global_base() const { return global_; }

  // Adds an image and returns its handle. Its place and its name are set here, and its texels are random
  // until run() sets them.
  uint32_t add_image(exec::ImageView view);
  // Counts the lanes of another op of the program in Outcome::lanes.
  void count(const isa::OpRow& row) { counted_ = &row; }
  Spaces random_spaces(Random& random) const;

  // Runs the op for the threads of `enabled` on both machines, whose outcomes must be equal.
  Outcome run(const std::vector<Column>& sources, uint64_t enabled, const Spaces& before);

  mem::AddressSpace memory;
  exec::World world;

 private:
  std::string program_text(const std::string& prelude);
  bool uses_shared() const;
  std::string copies(bool to_spaces) const;
  Outcome run_on(bool timing, const std::vector<Column>& sources, uint64_t enabled, const Spaces& before);
  void read_spaces(Spaces& out) const;

  const isa::OpRow& row_;
  const isa::OpRow* counted_ = &row_;
  const int32_t displacement_;
  const uint32_t num_extra_;
  size_t num_sources_ = 0, num_results_ = 0;
  exec::Image image_;
  Address inputs_ = 0, outputs_ = 0, global_ = 0, shared_ = 0, local_ = 0;
};

// Returns where a run that should have ended well differs from what it should have left, or "".
std::string difference(const Outcome& outcome, const std::vector<Column>& results, const Spaces& after);

// Returns the modifiers of an op's name: "ld.global.v2.b32" has {"ld", "global", "v2", "b32"}.
std::vector<std::string_view> parts_of(std::string_view name);

}  // namespace glint::test
