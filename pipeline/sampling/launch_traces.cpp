// Records lines and written bytes of launches, and does to memory and caches what they have done.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/launch_traces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "pipeline/sampling/line_touches.h"

namespace glint::pipeline {
namespace {

constexpr Address kChunkBytes = Address{1} << LineTouches::kChunkShift;
constexpr uint32_t kSectorsShift = 1, kLineShift = 9;  // the lowest bit says whether a line was written
constexpr uint64_t kLeastLine = mem::kSectorBytes;     // Lines are multiples of it.

// Packs a line, which is a multiple of its size, with its sectors. Physical addresses have less than 60 bits.
uint64_t packed(Address line, uint8_t sectors, mem::Touch touch) {
  return line / kLeastLine << kLineShift | uint64_t{sectors} << kSectorsShift |
         uint64_t{touch == mem::Touch::Write};
}

// Returns the bytes of a chunk that belong to its allocation.
uint64_t bytes_of(const mem::AddressSpace& memory, Address chunk) {
  const mem::AddressSpace::Slot& slot = memory.slots()[chunk >> mem::AddressSpace::kShift];
  const uint64_t offset = chunk & ((uint64_t{1} << mem::AddressSpace::kShift) - 1);
  return slot.bytes > offset ? std::min(kChunkBytes, slot.bytes - offset) : 0;
}

}  // namespace

// Fills a trace, and gives up when it has more bytes than there is room for.
class LaunchTraces::Recorder {
 public:
  Recorder(Trace& trace, uint64_t room) : trace_(trace), room_(room) {}

  void touch(Address line, uint8_t sectors, mem::Touch touch) {
    if (is_full_) return;
    trace_.touches.push_back(packed(line, sectors, touch));
    check_room();
  }
  void write(Address chunk) {
    Address& recent = recent_[chunk % recent_.size()];
    if (is_full_ || recent == chunk) return;
    recent = chunk;
    trace_.chunks.push_back(chunk << LineTouches::kChunkShift);
    check_room();
  }
  // Takes the bytes that the launch has left.
  void end(const mem::AddressSpace& memory) {
    if (is_full_) return;
    std::ranges::sort(trace_.chunks);
    const auto twice = std::ranges::unique(trace_.chunks);
    trace_.chunks.erase(twice.begin(), twice.end());
    trace_.chunks.shrink_to_fit(), trace_.touches.shrink_to_fit();
    uint64_t bytes = 0;
    for (const Address chunk : trace_.chunks) bytes += bytes_of(memory, chunk);
    if (trace_.bytes() + bytes > room_) return give_up();
    trace_.written.resize(bytes);
    std::byte* to = trace_.written.data();
    for (const Address chunk : trace_.chunks) {
      const uint64_t count = bytes_of(memory, chunk);
      std::memcpy(to, memory.find(chunk, count), count);
      to += count;
    }
    trace_.is_whole = true;
  }

 private:
  void check_room() {
    if (trace_.bytes() > room_) give_up();
  }
  void give_up() {
    is_full_ = true;
    trace_ = Trace{};
  }

  Trace& trace_;
  const uint64_t room_;
  bool is_full_ = false;
  std::array<Address, 1024> recent_{};  // chunks that are in the list already; number 0 is never used
};

FunctionalCounts LaunchTraces::record(const exec::World& world, const GpuParams& gpu,
                                      const LaunchWatch& watch) {
  Trace& trace = traces_.emplace_back();
  Recorder recorder(trace, most_bytes_ - std::min(most_bytes_, bytes_));
  LineTouches touches(
      world, gpu.memory,
      [&](Address line, uint8_t sectors, mem::Touch touch) {
        recorder.touch(line, sectors, touch);
        return 0u;
      },
      Written::StaysDirty);
  touches.tell_writes([&](Address chunk) { recorder.write(chunk); });
  FunctionalCounts counts = run_functional_heard(
      world, gpu.core.instruction_budget, watch,
      {.begin = [&](exec::Executor& executor) { touches.listen_to(executor); }, .nodes = touches.nodes()});
  if (counts.end == LaunchEnd::Whole) recorder.end(*world.memory);
  bytes_ += trace.bytes();
  return counts;
}

void LaunchTraces::replay(size_t launch, mem::AddressSpace& memory, mem::MemorySystem& caches) const {
  const Trace& trace = traces_[launch];
  for (const uint64_t one : trace.touches)
    caches.warm((one >> kLineShift) * kLeastLine, uint8_t(one >> kSectorsShift),
                one & 1 ? mem::Touch::Write : mem::Touch::Read);
  const std::byte* from = trace.written.data();
  for (const Address chunk : trace.chunks) {
    const uint64_t count = bytes_of(memory, chunk);
    std::memcpy(memory.find(chunk, count), from, count);
    from += count;
  }
}

void LaunchTraces::drop(size_t launch) {
  if (launch >= traces_.size()) return;
  bytes_ -= traces_[launch].bytes();
  traces_[launch] = Trace{};
}

}  // namespace glint::pipeline
