// Writes what structures of a capsule were built from, and reads it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pipeline/capsule/capsule.h"

namespace glint::setup {

using Json = nlohmann::ordered_json;

inline constexpr const char* kDamaged = "the capsule is damaged";

// Gathers the bytes that stand behind the description.
class Blobs {
 public:
  template <class T>
  Json add(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const size_t at = bytes_.size();
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    return {at, values.size_bytes()};
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// Throws when a description names bytes that are not there.
template <class T>
std::vector<T> blob(std::string_view blobs, const Json& place) {
  const uint64_t at = place.at(0), bytes = place.at(1);
  if (at > blobs.size() || bytes > blobs.size() - at || bytes % sizeof(T)) throw std::out_of_range(kDamaged);
  std::vector<T> out(bytes / sizeof(T));
  if (bytes) std::memcpy(out.data(), blobs.data() + at, bytes);
  return out;
}

Json json_of(const pipeline::PlacedStructure& structure, Blobs& blobs);
// Throws std::out_of_range or Json::exception when the description is damaged.
pipeline::PlacedStructure structure_of(const Json& json, std::string_view blobs);

}  // namespace glint::setup
