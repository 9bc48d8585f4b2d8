// Mistakes of a simulated program: what is said of them, and a log of those that are let pass.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "memsys/address_space.h"

namespace glint::exec {

// Stop: the first fault ends the run. Warn: what FaultKind names is noted and goes on, as docs/errors.md
// says.
enum class OnFault : uint8_t { Stop, Warn };
constexpr std::string_view name_of(OnFault on_fault) {
  return on_fault == OnFault::Stop ? "stop" : "warn";
}

// What can be let pass. Everything else ends a run: a stack that overflows, a program without end, broken
// control flow.
enum class FaultKind : uint8_t {
  OutOfBounds,  // of buffers, shared, local and constant memory; stores where only loads can be
  Misaligned,
  Image,      // no such image, another kind of image, a texel outside
  Record,     // outside of the binding table
  Structure,  // no acceleration structure, or an overwritten one
  Count
};
std::string_view name_of(FaultKind kind);
inline constexpr std::string_view kFaultsDoc =
    "Times that a lane did something wrong and `--on-fault warn` let it pass, by kind.";

// A mistake of the simulated program.
struct Fault {
  std::string what;   // "reads 4 bytes 16 bytes past the end of 'binding 4 (Vertices)'"
  std::string place;  // shader, GLSL file and line, instruction
  std::array<uint32_t, 3> launch_id{};
  bool is_deadlock = false;  // warps wait for each other for ever
  std::string to_string() const;
  Exit exit() const { return is_deadlock ? Exit::Stuck : Exit::Fault; }
};

// Faults that were let pass, by instruction and kind. What it holds does not depend on the order in which
// warps run.
class FaultLog {
 public:
  struct Entry {
    uint32_t pc = 0;
    FaultKind kind = FaultKind::OutOfBounds;
    uint64_t launch_index = 0;  // of `first`: x runs fastest
    uint64_t count = 0;         // every time a lane did it
    Fault first;                // the first time of the lowest launch index
    std::string to_string() const;
  };
  // `describe` is asked only when no lane of a launch index as low has done it before.
  void note(uint32_t pc, FaultKind kind, uint64_t launch_index, const std::function<Fault()>& describe);
  void add(const FaultLog& other);

  bool empty() const { return entries_.empty(); }
  uint64_t count(FaultKind kind) const;
  std::vector<Entry> in_order() const;  // of launch indices
  // All of them and how many they are, for people; "" when there are none.
  std::string to_string() const;
  // The message of a fault that ends the run, after those that were let pass before.
  std::string with(const Fault& last) const;

 private:
  std::map<std::pair<uint32_t, FaultKind>, Entry> entries_;
};

// "byte 64 of 'Vertices' (1200 bytes)", or how far outside of which allocation an address is, or that nobody
// bound it.
std::string whereabouts(const mem::AddressSpace& memory, Address address, uint64_t bytes);

}  // namespace glint::exec
