// Plays the host of a compute program: it keeps buffers, launches kernels and checks what they have computed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "compute/kernel.h"
#include "compute/program.h"
#include "pipeline/device.h"

namespace glint::compute {

// Reports that a program has computed something else than its reference.
class WrongResult : public Error {
 public:
  explicit WrongResult(const std::string& message) : Error(Exit::Failure, message) {}
};

// Says where `count` values of T lie in simulated memory.
template <class T>
struct Buffer {
  Address address = 0;
  uint64_t count = 0;
  operator pipeline::BufferRange() const { return {address, count * sizeof(T)}; }
};

// Names a launch in the table of a run's launches.
struct LaunchRecord {
  std::string kernel;
  std::array<uint32_t, 3> groups{};
  uint64_t cycles = 0, warp_instructions = 0, lane_instructions = 0;
};

// Says on what a program runs.
struct HostSetup {
  pipeline::GpuParams gpu;
  std::string kernels;  // folder with the GLSL and PTX files
  pipeline::LaunchMode mode;
  pipeline::LaunchWatch watch;
  frontend::ShaderCache* cache = nullptr;
  exec::OnFault on_fault = exec::OnFault::Stop;
  exec::PrintLog* prints = nullptr;
  // Runs a launch of a kernel in place of the device, when it is set. Its result needs no statistics.
  std::function<pipeline::RenderResult(const std::string& kernel, const exec::World& world)> run = {};
};

// Draws the numbers of an input. The same seed gives the same numbers everywhere.
class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  uint32_t below(uint32_t end) { return uint32_t(uint64_t{engine_()} * end >> 32); }
  // Returns a float from `low` up to `high`.
  float between(float low, float high) { return low + (high - low) * (float(engine_() >> 8) * 0x1p-24f); }
  std::vector<float> floats(size_t count, float low, float high) {
    std::vector<float> out(count);
    for (float& value : out) value = between(low, high);
    return out;
  }

 private:
  std::mt19937 engine_;
};

// A program is written as it would be against a driver:
//
//   const Buffer<float> values = host.buffer("values", input);         // stays between launches
//   host.launch("scale", {groups, 1, 1}, {values}, Constants{2.0f});   // kernels/scale.comp or scale.ptx
//   host.check("scaled", values, expected);                            // throws at the first wrong value
//
// Launches share the memory, and the L2 stays warm between them.
class Host {
 public:
  // Launches kernels of that form.
  explicit Host(HostSetup setup, Form form = Form::Glsl);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  Random random{1};

  template <class T>
  Buffer<T> buffer(const std::string& name, size_t count) {
    return {memory_->allocate(name, count * sizeof(T)), count};
  }
  template <class T>
  Buffer<T> buffer(const std::string& name, const std::vector<T>& values) {
    const Buffer<T> out = buffer<T>(name, values.size());
    memory_->write(out.address, values.data(), values.size() * sizeof(T));
    return out;
  }
  // Returns what a buffer holds, for reading and writing between launches.
  template <class T>
  std::span<T> view(const Buffer<T>& buffer) const {
    return memory_->view<T>(buffer.address, buffer.count);
  }

  // Runs the kernel of that name with these buffers and constants (compile_kernel()).
  template <class Constants>
  void launch(const std::string& kernel, const std::array<uint32_t, 3>& groups,
              const std::vector<pipeline::BufferRange>& buffers, const Constants& constants) {
    launch(kernel, groups, buffers, std::as_bytes(std::span(&constants, 1)));
  }
  void launch(const std::string& kernel, const std::array<uint32_t, 3>& groups,
              const std::vector<pipeline::BufferRange>& buffers, std::span<const std::byte> constants);

  // Throws WrongResult at the first value that is not the expected one. Integers are to be equal. A float may
  // differ by `tolerance` times the larger of 1 and its magnitude; without tolerance it is to be equal,
  // except where compiler.contract makes one rounding of two.
  template <class T>
  void check(const std::string& name, const Buffer<T>& buffer, const std::vector<T>& expected,
             double tolerance = 0) {
    const std::span<const T> got = view(buffer);
    check_count(name, got.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i)
      if (got[i] != expected[i] &&
          !is_near(double(got[i]), double(expected[i]), std::is_integral_v<T>, tolerance))
        wrong(name, i, double(got[i]), double(expected[i]));
  }

  uint64_t checked() const { return checked_; }  // values
  const std::vector<LaunchRecord>& launches() const { return launches_; }
  // Returns the sum of all launches.
  pipeline::RenderResult take_result() { return std::move(sum_); }

 private:
  Kernel& kernel(const std::string& name);
  void run(const std::string& kernel, const std::array<uint32_t, 3>& groups, const exec::World& world);
  void check_count(const std::string& name, size_t got, size_t expected);
  bool is_near(double got, double expected, bool exact, double tolerance) const;
  [[noreturn]] static void wrong(const std::string& name, size_t index, double got, double expected);

  HostSetup setup_;
  Form form_;
  std::shared_ptr<mem::AddressSpace> memory_ = std::make_shared<mem::AddressSpace>();
  pipeline::Device device_;
  std::map<std::string, std::unique_ptr<Kernel>> kernels_;
  std::vector<LaunchRecord> launches_;
  pipeline::RenderResult sum_;
  uint64_t checked_ = 0;
};

// Returns how many groups of `size` cover `count`.
inline uint32_t groups_of(uint64_t count, uint32_t size) {
  return uint32_t((count + size - 1) / size);
}

// Holds what a program has done.
struct ProgramResult {
  pipeline::RenderResult sum;  // of all launches
  std::vector<LaunchRecord> launches;
  uint64_t checked = 0;  // values compared with the reference; 0 when a launch was ended early
};

// Runs a program to its end, or until the watch ends one of its launches. Throws WrongResult where a value is
// not that of the reference, and what Device::run() throws.
ProgramResult run_program(const Program& program, Size size, HostSetup setup);

}  // namespace glint::compute
