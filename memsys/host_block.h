// Holds bytes of the host that become bytes of simulated memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <sys/mman.h>
#include <type_traits>
#include <utility>

#include "base/file_pages.h"

namespace glint::mem {

// Frees memory of std::malloc, or `mapped` bytes of pages.
struct FreeHostMemory {
  size_t mapped = 0;
  void operator()(void* memory) const {
    if (mapped)
      FreePages{mapped}(memory);
    else
      std::free(memory);
  }
};

// Says how much of a large block the host gives at a first touch. Whole blocks get pages of 2 MiB where the
// host has them, which takes a tenth of the time. Sparse blocks get pages of 4 KiB, because most of such a
// block is never touched.
enum class Filling : uint8_t { Whole, Sparse };

// Holds bytes that are aligned to 64 bytes, and 0 at first unless they come from elsewhere. The host gives a
// page of a large block when the page is first touched, so that the threads that fill a block also share the
// cost of its pages, and pages that nobody touches cost nothing. A moved block is empty. Throws
// std::bad_alloc when the host has no memory.
class HostBlock {
 public:
  static constexpr uint64_t kAlignment = 64;

  HostBlock() = default;
  // The host's bytes are whole cache lines, so that a line can be copied even where only a part is used.
  explicit HostBlock(uint64_t bytes, Filling filling = Filling::Whole) : size_(bytes) {
    const auto whole = size_t((bytes / kAlignment + 2) * kAlignment);
    memory_ = bytes < kMapped ? Memory(std::calloc(1, whole)) : mapped(whole, filling);
    if (!memory_) throw std::bad_alloc();
    const auto at = reinterpret_cast<uintptr_t>(memory_.get());
    data_ = static_cast<std::byte*>(memory_.get()) + (kAlignment - at % kAlignment) % kAlignment;
  }
  // Shows bytes that live as long as `owner` does. They are aligned, and end with a whole line of the host.
  HostBlock(std::shared_ptr<void> owner, std::byte* data, uint64_t bytes)
      : owner_(std::move(owner)), data_(data), size_(bytes) {}
  // Takes over pages that hold `bytes` bytes from `data` on, which is aligned, and at least 2 * kAlignment
  // more.
  HostBlock(Pages pages, std::byte* data, uint64_t bytes) : data_(data), size_(bytes) {
    const size_t mapped = pages.get_deleter().bytes;
    memory_ = Memory(pages.release(), FreeHostMemory{mapped});
  }
  HostBlock(HostBlock&& other) noexcept
      : memory_(std::move(other.memory_)),
        owner_(std::move(other.owner_)),
        data_(std::exchange(other.data_, nullptr)),
        size_(std::exchange(other.size_, 0)) {}
  HostBlock& operator=(HostBlock&& other) noexcept {
    memory_ = std::move(other.memory_);
    owner_ = std::move(other.owner_);
    data_ = std::exchange(other.data_, nullptr);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }

  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }
  uint64_t size() const { return size_; }  // bytes

 private:
  // std::calloc writes zeros into memory that was in use before, which large blocks would pay for all bytes.
  static constexpr uint64_t kMapped = 1 << 20;  // bytes from which a block has pages of its own
  using Memory = std::unique_ptr<void, FreeHostMemory>;
  static Memory mapped(size_t bytes, Filling filling) {
    void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return {};
#ifdef MADV_HUGEPAGE
    if (filling == Filling::Whole) madvise(memory, bytes, MADV_HUGEPAGE);  // A host without them ignores it.
#endif
    return Memory(memory, FreeHostMemory{bytes});
  }

  Memory memory_;
  std::shared_ptr<void> owner_;  // of bytes that several blocks share
  std::byte* data_ = nullptr;
  uint64_t size_ = 0;
};

// Holds objects in such bytes. All bytes of an object that was not written are 0.
template <class T>
class HostArray {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= HostBlock::kAlignment);

 public:
  HostArray() = default;
  explicit HostArray(size_t count, Filling filling = Filling::Whole) : block_(count * sizeof(T), filling) {}

  T* data() { return reinterpret_cast<T*>(block_.data()); }
  const T* data() const { return reinterpret_cast<const T*>(block_.data()); }
  size_t size() const { return size_t(block_.size() / sizeof(T)); }
  bool empty() const { return size() == 0; }
  T* begin() { return data(); }
  T* end() { return data() + size(); }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size(); }
  T& operator[](size_t i) { return data()[i]; }
  const T& operator[](size_t i) const { return data()[i]; }

 private:
  HostBlock block_;
};

}  // namespace glint::mem
