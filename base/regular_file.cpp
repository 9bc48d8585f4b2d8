// Reads the bytes of a regular file.
// SPDX-License-Identifier: Apache-2.0
#include "base/regular_file.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "base/parallel_ranges.h"

namespace glint {
namespace {

template <class Bytes>
std::optional<Bytes> read_whole(const std::string& path) {
  constexpr uintmax_t kLeast =
      4096;  // bytes asked for where the file system states no size, as that of /proc
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  const uintmax_t stated = std::filesystem::file_size(path, error);
  Bytes out;
  size_t have = 0;
  // One more byte than stated is asked for, which tells whether the file ends there.
  for (size_t want = size_t(std::max(error ? 0 : stated + 1, kLeast)); in; want = have + kLeast) {
    out.resize(std::max(want, have + have / 2));
    in.read(reinterpret_cast<char*>(out.data()) + have, std::streamsize(out.size() - have));
    have += size_t(in.gcount());
  }
  out.resize(have);
  return out;
}

}  // namespace

std::optional<std::string> read_regular_file(const std::string& path) {
  return read_whole<std::string>(path);
}
std::optional<std::vector<unsigned char>> read_regular_bytes(const std::string& path) {
  return read_whole<std::vector<unsigned char>>(path);
}

uint64_t size_of_regular_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return 0;
  const uintmax_t size = std::filesystem::file_size(path, error);
  return error ? 0 : size;
}

bool read_regular_file(const std::string& path, std::span<char> out, uint32_t threads) {
  constexpr size_t kPart = 16 << 20;  // bytes that a thread reads at a time
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || !std::ifstream(path)) return false;
  std::atomic<bool> is_whole = true;
  parallel_ranges(out.size(), kPart, threads, [&](size_t begin, size_t end) {
    std::ifstream in(path, std::ios::binary);
    in.seekg(std::streamoff(begin));
    if (!in.read(out.data() + begin, std::streamsize(end - begin))) is_whole = false;
  });
  return is_whole;
}

}  // namespace glint
