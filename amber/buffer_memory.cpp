// Uploads buffers and opens windows on them.
// SPDX-License-Identifier: Apache-2.0
#include "amber/buffer_memory.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace glint::amber {

Address BufferMemory::range(const Buffer& buffer, uint64_t first, uint64_t end) {
  // A range has a word at least, so that an empty buffer has an address and a byte can be read as a word.
  constexpr uint64_t kLeast = 4;
  const uint64_t bytes = buffer.bytes.size();
  const auto [copy, is_new] = copies_.try_emplace(buffer.name);
  if (is_new) {
    copy->second.bytes = bytes;
    copy->second.backing = memory_.add_backing(bytes + kLeast);
    if (bytes) std::memcpy(memory_.data(copy->second.backing), buffer.bytes.data(), bytes);
  }
  const auto [range, is_new_range] = copy->second.ranges.try_emplace({first, end}, 0);
  if (is_new_range) {
    const std::string title =
        end - first == bytes ? buffer.name : fmt::format("{}, bytes {} to {}", buffer.name, first, end);
    range->second = memory_.open_window(title, copy->second.backing, first, std::max(end - first, kLeast));
  }
  return range->second;
}

void BufferMemory::update(const Buffer& buffer) {
  const auto found = copies_.find(buffer.name);
  if (found == copies_.end()) return;
  Copy& copy = found->second;
  if (copy.bytes == buffer.bytes.size()) {
    if (copy.bytes) std::memcpy(memory_.data(copy.backing), buffer.bytes.data(), copy.bytes);
    return;
  }
  for (const auto& [range, address] : copy.ranges) memory_.free(address);
  memory_.free(copy.backing);
  copies_.erase(found);
}

void BufferMemory::read_back(Buffer& buffer) const {
  const auto copy = copies_.find(buffer.name);
  if (copy == copies_.end() || buffer.bytes.empty()) return;
  std::memcpy(buffer.bytes.data(), memory_.data(copy->second.backing), buffer.bytes.size());
}

}  // namespace glint::amber
