// Describes mistakes of a simulated program, and logs those that are let pass.
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

// Says what a fault does. With Stop, the first fault ends the run. With Warn, faults that FaultKind names are
// noted, and the run goes on as docs/errors.md says.
enum class OnFault : uint8_t { Stop, Warn };
constexpr std::string_view name_of(OnFault on_fault) {
  return on_fault == OnFault::Stop ? "stop" : "warn";
}

// Names the kinds of faults that can be let pass. All other faults end a run, such as a stack that overflows,
// a program without end, or broken control flow.
enum class FaultKind : uint8_t {
  // An access lies outside of a buffer, or of shared, local or constant memory, or a store goes to memory
  // that can only be read.
  OutOfBounds,
  Misaligned,
  Image,      // the image does not exist or is of another kind, or the texel lies outside of it
  Record,     // the record lies outside of the binding table
  Structure,  // the address holds no acceleration structure, or an overwritten one
  Barrier,    // only a part of a warp comes to a barrier
  Count
};
std::string_view name_of(FaultKind kind);
inline constexpr std::string_view kFaultsDoc =
    "Number of times that a lane did something wrong and `--on-fault warn` let it pass, by kind.";

// Describes a mistake of the simulated program.
struct Fault {
  std::string what;   // "reads 4 bytes 16 bytes past the end of 'binding 4 (Vertices)'"
  std::string place;  // shader, GLSL file and line, and instruction
  std::array<uint32_t, 3> launch_id{};
  bool is_deadlock = false;  // warps wait for each other for ever
  std::string to_string() const;
  Exit exit() const { return is_deadlock ? Exit::Stuck : Exit::Fault; }
};

// Holds faults that were let pass, by instruction and kind. Its content does not depend on the order in which
// warps run.
class FaultLog {
 public:
  struct Entry {
    uint32_t pc = 0;
    FaultKind kind = FaultKind::OutOfBounds;
    uint64_t launch_index = 0;  // launch index of `first`; x runs fastest
    uint64_t count = 0;         // how often a lane did it
    Fault first;                // the first time at the lowest launch index
    std::string to_string() const;
  };
  // Notes a fault. `describe` is called only when no lane with as low a launch index has done it before.
  void note(uint32_t pc, FaultKind kind, uint64_t launch_index, const std::function<Fault()>& describe);
  void add(const FaultLog& other);

  bool empty() const { return entries_.empty(); }
  uint64_t count(FaultKind kind) const;
  std::vector<Entry> in_order() const;  // ordered by launch index
  // Returns all of them and their number as text, or "" when there are none.
  std::string to_string() const;
  // Returns the message of a fault that ends the run, after those that were let pass before.
  std::string with(const Fault& last) const;

 private:
  std::map<std::pair<uint32_t, FaultKind>, Entry> entries_;
};

// Returns text such as "byte 64 of 'Vertices' (1200 bytes)". It also says how far outside of which allocation
// an address is, or that nothing is bound to it.
std::string whereabouts(const mem::AddressSpace& memory, Address address, uint64_t bytes);

}  // namespace glint::exec
