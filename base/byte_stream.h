// Turns values into bytes and back for files of caches: numbers, texts, lists, and what has fields. Only the
// build that wrote the bytes can read them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace glint {

// Is a type whose namespace has for_each_field(value, visit), which calls visit(field) for each field in
// turn.
template <class T>
concept HasFields = requires(T& value) {
  for_each_field(value, [](auto&) {});
};

// Is a type whose bytes are its value.
template <class T>
concept PlainBytes = std::is_trivially_copyable_v<T>;

class ByteWriter {
 public:
  template <PlainBytes T>
  void put(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put(const std::string& text) {
    put(uint64_t(text.size()));
    bytes_ += text;
  }
  template <class T>
  void put(const std::vector<T>& list) {
    put(uint64_t(list.size()));
    if constexpr (PlainBytes<T>)
      bytes_.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
    else
      for (const T& each : list) put(each);
  }
  template <class First, class Second>
  requires(!PlainBytes<std::pair<First, Second>>) void put(const std::pair<First, Second>& both) {
    put(both.first);
    put(both.second);
  }
  template <HasFields T>
  requires(!PlainBytes<T>) void put(const T& value) {
    for_each_field(const_cast<T&>(value), [this](const auto& field) { put(field); });  // only reads
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Reads what a ByteWriter wrote, in the same order. A value that does not fit into the bytes left reads as
// empty, and is_good() is false afterwards.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <PlainBytes T>
  void get(T& value) {
    take_bytes(&value, sizeof value);
  }
  void get(std::string& text) {
    uint64_t size = 0;
    get(size);
    if (!has(size)) return;
    text = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
  }
  template <class T>
  void get(std::vector<T>& list) {
    uint64_t size = 0;
    get(size);
    if (!has(size)) return;  // Each element takes at least one byte.
    if constexpr (PlainBytes<T>) {
      if (!has(size * sizeof(T))) return;
      list.resize(size);
      take_bytes(list.data(), size * sizeof(T));
    } else {
      list.resize(size);
      for (T& each : list) get(each);
    }
  }
  template <class First, class Second>
  requires(!PlainBytes<std::pair<First, Second>>) void get(std::pair<First, Second>& both) {
    get(both.first);
    get(both.second);
  }
  template <HasFields T>
  requires(!PlainBytes<T>) void get(T& value) {
    for_each_field(value, [this](auto& field) { get(field); });
  }
  template <class T>
  T take() {
    T value{};
    get(value);
    return value;
  }
  bool is_good() const { return good_ && bytes_.empty(); }

 private:
  bool has(uint64_t size) {
    good_ &= size <= bytes_.size();
    return good_;
  }
  void take_bytes(void* to, uint64_t size) {
    if (size == 0 || !has(size)) return;
    std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }

  std::string_view bytes_;
  bool good_ = true;
};

}  // namespace glint
