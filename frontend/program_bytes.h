// Turns values into bytes and back for the cache: numbers, texts, lists, programs. Only the build that wrote
// the bytes can read them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "isa/program.h"

namespace glint::frontend {

class ByteWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void put(const std::string& text) {
    put(uint64_t(text.size()));
    bytes_ += text;
  }
  template <class T>
  void put(const std::vector<T>& list) {
    put(uint64_t(list.size()));
    for (const T& each : list) put(each);
  }
  void put(const std::pair<uint32_t, std::string>& label) {
    put(label.first);
    put(label.second);
  }
  void put(const isa::Scope& scope) {
    put(scope.function);
    put(scope.caller);
    put(scope.call);
  }
  void put(const isa::SpirvLine& line) {
    put(line.text);
    put(line.line);
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

  template <class T>
  requires std::is_trivially_copyable_v<T>
  void get(T& value) {
    if (!has(sizeof value)) return;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
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
    list.resize(size);
    for (T& each : list) get(each);
  }
  void get(std::pair<uint32_t, std::string>& label) {
    get(label.first);
    get(label.second);
  }
  void get(isa::Scope& scope) {
    get(scope.function);
    get(scope.caller);
    get(scope.call);
  }
  void get(isa::SpirvLine& line) {
    get(line.text);
    get(line.line);
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

  std::string_view bytes_;
  bool good_ = true;
};

void put_program(ByteWriter& out, const isa::Program& program);
isa::Program get_program(ByteReader& in);

}  // namespace glint::frontend
