// Writes and reads NumPy's files.
// SPDX-License-Identifier: Apache-2.0
#include "report/picture/npy.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <limits>

#include "base/diagnostics.h"

namespace glint::report {
namespace {

constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);
static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

template <class T>
std::string raw(const std::vector<double>& values) {
  std::string out(values.size() * sizeof(T), '\0');
  for (size_t i = 0; i < values.size(); ++i) {
    const auto number = T(std::min(values[i], double(std::numeric_limits<T>::max())));
    std::memcpy(out.data() + i * sizeof(T), &number, sizeof(T));
  }
  return out;
}

template <class T>
void read_numbers(std::string_view data, std::vector<double>& out) {
  out.resize(data.size() / sizeof(T));
  for (size_t i = 0; i < out.size(); ++i) {
    T number;
    std::memcpy(&number, data.data() + i * sizeof(T), sizeof(T));
    out[i] = double(number);
  }
}

}  // namespace

// Writes an array. The header ends at a multiple of 64 bytes.
std::string npy_bytes(const std::string& dtype, const std::string& shape, std::string_view data) {
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", dtype, shape);
  header.append((64 - (kMagic.size() + 2 + header.size() + 1) % 64) % 64, ' ');
  header += '\n';
  std::string out(kMagic);
  out += char(header.size() & 0xff);
  out += char(header.size() >> 8);
  return out.append(header).append(data);
}

std::string npy_of_map(const CostMap& map) {
  const std::string shape = fmt::format("({}, {})", map.height, map.width);
  return map.is_count ? npy_bytes("<u4", shape, raw<uint32_t>(map.values))
                      : npy_bytes("<f4", shape, raw<float>(map.values));
}

void read_npy(const std::string& bytes, const std::string& name, CostMap& map) {
  const auto refuse = [&]() {
    return UserError({name}, "this is not a map of cost", "the file is damaged; run it again");
  };
  if (bytes.size() < 10 || std::string_view(bytes).substr(0, 8) != kMagic) throw refuse();
  const size_t header = uint8_t(bytes[8]) + 256u * uint8_t(bytes[9]);
  if (bytes.size() < 10 + header) throw refuse();
  const std::string text = bytes.substr(10, header);
  const std::string_view data = std::string_view(bytes).substr(10 + header);
  char kind = 0;
  if (std::sscanf(text.c_str(), "{'descr': '<%c4', 'fortran_order': False, 'shape': (%u, %u)", &kind,
                  &map.height, &map.width) != 3)
    throw refuse();
  if ((kind != 'u' && kind != 'f') || data.size() != size_t{map.width} * map.height * 4) throw refuse();
  map.is_count = kind == 'u';
  map.is_count ? read_numbers<uint32_t>(data, map.values) : read_numbers<float>(data, map.values);
}

}  // namespace glint::report
