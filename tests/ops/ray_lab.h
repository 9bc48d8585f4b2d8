// Runs a pipeline of several shaders with a binding table on all machines, and gives back what the shaders
// logged.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "exec/image.h"
#include "isa/op_row.h"
#include "memsys/address_space.h"
#include "tests/ops/machine_run.h"

namespace glint::test {

struct LabShader {
  std::string_view stage;
  std::string body;  // begins behind own_words()
};

// Holds a word of each place, for each thread.
using ThreadWords = std::vector<std::vector<uint32_t>>;

class RayLab {
 public:
  static constexpr uint32_t kInputWords = 32, kLogWords = 192;
  // A word of the log that no shader has written.
  static constexpr uint32_t kUnwritten = 0xdead'beef;
  static constexpr uint32_t kRecordStride = 64;  // bytes
  // The frame of each shader in bytes. A path of calls is at most four frames deep.
  static constexpr uint32_t kFrameBytes = 512;

  // Links the shaders. The first generates rays for kThreads threads. Afterwards the caller fills in the
  // world's miss, hit and callable, which are indices into the shaders.
  explicit RayLab(const std::vector<LabShader>& shaders);
  RayLab(const RayLab&) = delete;
  RayLab& operator=(const RayLab&) = delete;

  // Puts the binding table into memory. The first word of the data of each record is record_word().
  void place_table();

  struct Outcome {
    ThreadWords log;
    uint64_t lanes = 0;  // lanes that executed the counted op, as the machine says
  };
  // Runs the pipeline on all machines, whose outcomes must be equal and without a fault.
  Outcome run(const isa::OpRow& counted, const ThreadWords& inputs);

  mem::AddressSpace memory;
  exec::World world;

 private:
  Outcome run_on(Machine which, const isa::OpRow& counted, const ThreadWords& inputs);

  exec::Image image_;
  Address inputs_ = 0, log_ = 0;
};

// Says which part of the table a record belongs to.
enum class Region : uint32_t { RayGeneration, Miss, Hit, Callable };
uint32_t record_word(Region region, uint32_t record);

// Returns instructions that make %rd2 the address of the thread's inputs, and %rd4 that of its log.
std::string own_words();
// Returns instructions that log a register of 32 bits, or a predicate. %r9 is lost.
std::string log_word(uint32_t at, std::string_view value);
std::string log_predicate(uint32_t at, std::string_view predicate);

}  // namespace glint::test
