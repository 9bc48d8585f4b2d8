// Provides the recorded inputs and outputs of the calibration kernels, which lie next to the repository.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>
#include <zstd.h>

#include "tests/support/catch.h"

namespace glint {

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Holds the recorded outputs by the first word of their lines in valid_out.txt. Outputs of one name are in
// order.
class Outputs {
 public:
  explicit Outputs(const std::filesystem::path& folder) {
    const std::string packed = read_file(folder / "valid_out.bin.zst");
    data_.resize(ZSTD_getFrameContentSize(packed.data(), packed.size()));
    REQUIRE(ZSTD_decompress(data_.data(), data_.size(), packed.data(), packed.size()) == data_.size());
    std::istringstream lines(read_file(folder / "valid_out.txt"));
    for (std::string line; std::getline(lines, line);) {
      const size_t at = std::stoul(line.substr(line.find("off=") + 4)),
                   bytes = std::stoul(line.substr(line.find("bytes=") + 6));
      ranges_.push_back({line.substr(0, line.find(" off=")), at, bytes});
    }
  }
  template <class T>
  std::vector<T> get(const std::string& start) const {
    for (const Range& r : ranges_) {
      if (!r.name.starts_with(start)) continue;
      std::vector<T> out(r.bytes / sizeof(T));
      std::memcpy(out.data(), data_.data() + r.at, r.bytes);
      return out;
    }
    FAIL("no recorded output '" << start << "'");
    return {};
  }

 private:
  struct Range {
    std::string name;
    size_t at, bytes;
  };
  std::string data_;
  std::vector<Range> ranges_;
};

// Holds the inputs of the host program. They come from its generator, in the order in which it drew them.
struct Inputs {
  static constexpr uint32_t kCount = 1 << 18;
  uint32_t state = 12345;
  uint32_t next() { return state = state * 1664525u + 1013904223u; }
  float next_float() { return float(next() >> 8) * (1.0f / 16777216.0f); }
  std::vector<float> a = std::vector<float>(kCount), b = a, table = std::vector<float>(1 << 20);
  std::vector<uint32_t> u = std::vector<uint32_t>(kCount), index = u;

  Inputs() {
    for (float& x : a) x = next_float();
    for (float& x : b) x = next_float();
    for (uint32_t& x : u) x = next() >> 16;
    for (uint32_t& x : index) x = next() >> 12;
    for (float& x : table) x = next_float();
  }
};

}  // namespace glint
