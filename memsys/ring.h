// Declares a first-in first-out queue that allocates nothing once it has grown to its largest use.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstddef>
#include <vector>

namespace glint::mem {

template <class T>
class Ring {
 public:
  explicit Ring(size_t expected = 16) : items_(std::bit_ceil(expected < 2 ? size_t{2} : expected)) {}

  void push(const T& item) {
    if (size_ > mask_) [[unlikely]]
      grow();
    items_[(head_ + size_++) & mask_] = item;
  }
  const T& front() const { return items_[head_]; }
  T& front() { return items_[head_]; }
  T& back() { return items_[(head_ + size_ - 1) & mask_]; }
  void pop() {
    head_ = (head_ + 1) & mask_;
    --size_;
  }
  bool empty() const { return size_ == 0; }
  size_t size() const { return size_; }

 private:
  void grow() {
    std::vector<T> larger(items_.size() * 2);
    for (size_t i = 0; i < size_; ++i) larger[i] = items_[(head_ + i) & mask_];
    items_.swap(larger);
    mask_ = items_.size() - 1;
    head_ = 0;
  }

  std::vector<T> items_;
  size_t mask_ = items_.size() - 1;  // The number of items is a power of two.
  size_t head_ = 0, size_ = 0;
};

}  // namespace glint::mem
