// Reads names of types, applies GLSL's layout rules, and turns numbers into bytes and back.
// SPDX-License-Identifier: Apache-2.0
#include "amber/type.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <map>
#include <regex>

namespace glint::amber {
namespace {

const std::map<std::string, Scalar>& scalar_names() {
  static const std::map<std::string, Scalar> names{
      {"int8", Scalar::I8},     {"uint8", Scalar::U8},   {"int16", Scalar::I16},  {"uint16", Scalar::U16},
      {"float16", Scalar::F16}, {"int32", Scalar::I32},  {"uint32", Scalar::U32}, {"float", Scalar::F32},
      {"int64", Scalar::I64},   {"uint64", Scalar::U64}, {"double", Scalar::F64}};
  return names;
}

std::optional<exec::TexelFormat> texel_format(const std::string& glint_name) {
  for (size_t i = 0; i < size_t(exec::kFirstBlockFormat); ++i)
    if (exec::info_of(exec::TexelFormat(i)).name == glint_name) return exec::TexelFormat(i);
  return std::nullopt;
}

std::optional<Scalar> channel_scalar(int bits, const std::string& numeric) {
  const bool is_signed = numeric == "SINT" || numeric == "SNORM" || numeric == "SSCALED";
  switch (bits) {
    case 8:
      return is_signed ? Scalar::I8 : Scalar::U8;
    case 16:
      return numeric == "SFLOAT" ? Scalar::F16 : is_signed ? Scalar::I16 : Scalar::U16;
    case 32:
      return numeric == "SFLOAT" ? Scalar::F32 : is_signed ? Scalar::I32 : Scalar::U32;
    case 64:
      return numeric == "SFLOAT" ? Scalar::F64 : is_signed ? Scalar::I64 : Scalar::U64;
    default:
      return std::nullopt;
  }
}

// A texel of 64 bits is stored as two channels of 32 bits.
constexpr auto kHalves = exec::TexelFormat::Rg32Uint;

// Reads Vulkan's names of formats, without VK_FORMAT_.
std::optional<Type> format_named(const std::string& name) {
  Type type;
  type.name = name, type.is_packed = true;
  std::smatch m;
  if (std::regex_match(name, m, std::regex("A8B8G8R8_(UNORM|SNORM|UINT|SINT|SRGB)_PACK32")))
    return format_named("R8G8B8A8_" + m[1].str());
  type.format = exec::format_of_vulkan(name);
  if (type.format && exec::info_of(*type.format).block > 1) return std::nullopt;
  if (type.format && exec::info_of(*type.format).bits == 0) {
    const uint32_t bytes = exec::info_of(*type.format).bytes;
    type.scalar = bytes == 1 ? Scalar::U8 : bytes == 2 ? Scalar::U16 : Scalar::U32;
    return type;
  }
  if (!std::regex_match(
          name, m,
          std::regex("((?:[RGBA](?:8|16|32|64))+)_(UNORM|SNORM|UINT|SINT|SFLOAT|SRGB|SSCALED|USCALED)")))
    return std::nullopt;
  int bits = 0;
  type.rows = 0;
  const std::string list = m[1].str(), numeric = m[2].str();
  const std::regex channel("([RGBA])(\\d+)");
  for (std::sregex_iterator it(list.begin(), list.end(), channel), end; it != end; ++it)
    ++type.rows, bits = std::stoi((*it)[2].str());
  type.scalar = *channel_scalar(bits, numeric);
  return type;
}

// Returns the format whose texels are such numbers: an image of vec4<float> holds R32G32B32A32_SFLOAT.
std::optional<exec::TexelFormat> format_like(const Type& type) {
  if (type.columns != 1 || type.rows == 3) return std::nullopt;
  if (type.rows == 1 && (type.scalar == Scalar::I64 || type.scalar == Scalar::U64)) return kHalves;
  const char* channels = type.rows == 1 ? "r" : type.rows == 2 ? "rg" : "rgba";
  const bool is_signed =
      type.scalar == Scalar::I8 || type.scalar == Scalar::I16 || type.scalar == Scalar::I32;
  return texel_format(fmt::format("{}{}_{}", channels, bytes_of(type.scalar) * 8,
                                  is_float(type.scalar) ? "float"
                                  : is_signed           ? "sint"
                                                        : "uint"));
}

uint32_t round_up(uint32_t value, uint32_t to) {
  return (value + to - 1) / to * to;
}

// Applies the Khronos GLSL 4.60 specification, 7.6.2.2 "Standard Uniform Block Layout", rules 1 to 10.
class LayoutMaker {
 public:
  explicit LayoutMaker(bool std140) : std140_(std140) {}

  uint32_t alignment(const Type& t) const {
    if (t.is_packed) return bytes_of(t.scalar);
    if (!t.is_struct()) return t.columns > 1 ? aggregate(vector_alignment(t)) : vector_alignment(t);
    uint32_t largest = 1;
    for (const Member& m : t.members)
      largest = std::max(largest, m.count ? aggregate(alignment(*m.type)) : alignment(*m.type));
    return aggregate(largest);
  }
  uint32_t size(const Type& t, std::optional<uint32_t> matrix_stride = {}) const {
    if (t.is_struct()) return t.stride.value_or(round_up(end_of_members(t), alignment(t)));
    const uint32_t column = bytes_of(t.scalar) * t.rows;
    return t.columns > 1 ? t.columns * matrix_stride.value_or(alignment(t)) : column;
  }
  void add(const Type& t, uint32_t at, std::optional<uint32_t> matrix_stride = {}) {
    if (out.slots.size() > kMostNumbers) return;
    if (t.is_struct()) {
      walk(t, [&](const Member& m, uint32_t offset) { add(*m.type, at + offset, m.matrix_stride); });
      return;
    }
    const uint32_t stride = matrix_stride.value_or(alignment(t));
    for (uint32_t c = 0; c < t.columns; ++c)
      for (uint32_t r = 0; r < t.rows; ++r)
        out.slots.push_back({at + c * stride + r * bytes_of(t.scalar), t.scalar});
  }
  Layout out;

 private:
  uint32_t aggregate(uint32_t a) const { return std140_ ? round_up(a, 16) : a; }
  static uint32_t vector_alignment(const Type& t) { return bytes_of(t.scalar) * (t.rows == 3 ? 4 : t.rows); }
  uint32_t array_stride(const Member& m) const {
    const uint32_t a = aggregate(alignment(*m.type));
    return m.array_stride.value_or(round_up(size(*m.type, m.matrix_stride), a));
  }
  // Calls `call` for every member and every element of its array. Returns the end of the last one.
  template <class F>
  uint32_t walk(const Type& t, const F& call) const {
    uint32_t end = 0;
    for (const Member& m : t.members) {
      const uint32_t begin =
          m.offset.value_or(round_up(end, m.count ? aggregate(alignment(*m.type)) : alignment(*m.type)));
      const uint32_t stride = m.count ? array_stride(m) : 0;
      for (uint32_t i = 0; i < m.count.value_or(1); ++i) call(m, begin + i * stride);
      const bool is_padded = !m.count && std140_ && m.type->is_struct();
      end = begin + (m.count ? *m.count * stride : size(*m.type, m.matrix_stride));
      if (is_padded) end = round_up(end, 16);
    }
    return end;
  }
  uint32_t end_of_members(const Type& t) const {
    return walk(t, [](const Member&, uint32_t) {});
  }
  const bool std140_;
};

}  // namespace

uint32_t bytes_of(Scalar scalar) {
  constexpr uint8_t kBytes[] = {1, 1, 2, 2, 2, 4, 4, 4, 8, 8, 8};
  return kBytes[size_t(scalar)];
}

std::optional<Type> type_named(const std::string& name) {
  const auto& scalars = scalar_names();
  Type type;
  type.name = name;
  std::smatch m;
  if (const auto found = scalars.find(name); found != scalars.end()) {
    type.scalar = found->second;
  } else if (std::regex_match(name, m, std::regex("(?:vec([234])|mat([234])x([234]))<(\\w+)>")) &&
             scalars.count(m[4].str())) {
    type.scalar = scalars.at(m[4].str());
    type.rows = uint32_t(std::stoi(m[1].matched ? m[1].str() : m[3].str()));
    if (m[2].matched) type.columns = uint32_t(std::stoi(m[2].str()));
  } else {
    return format_named(name);
  }
  type.format = format_like(type);
  return type;
}

// Choice: in both layouts, the elements of a buffer of scalars or vectors follow each other as in std430, and
// a vector of three has room for a fourth component. The reference implementation does the same.
Layout lay_out(const Type& type, bool std140) {
  LayoutMaker maker(std140);
  maker.add(type, 0);
  maker.out.stride =
      type.is_packed || type.stride ? maker.size(type) : round_up(maker.size(type), maker.alignment(type));
  return maker.out;
}

bool parse_integer(const std::string& text, int64_t& out) {
  const bool is_negative = !text.empty() && text[0] == '-';
  const std::string digits = is_negative || (!text.empty() && text[0] == '+') ? text.substr(1) : text;
  if (digits.empty() || !std::isdigit(static_cast<unsigned char>(digits[0]))) return false;
  const int base = digits.size() > 2 && (digits[1] == 'x' || digits[1] == 'X') ? 16 : 10;
  char* end = nullptr;
  const uint64_t value = std::strtoull(digits.c_str(), &end, base);
  if (*end) return false;
  out = int64_t(is_negative ? 0 - value : value);
  return true;
}

bool parse_real(const std::string& text, double& out) {
  char* end = nullptr;
  out = std::strtod(text.c_str(), &end);
  return !text.empty() && end == text.c_str() + text.size();
}

void put_real(Scalar scalar, double value, std::byte* at) {
  const float single = float(value);
  const uint16_t half = exec::to_half(single);
  if (scalar == Scalar::F64)
    std::memcpy(at, &value, 8);
  else if (scalar == Scalar::F32)
    std::memcpy(at, &single, 4);
  else if (scalar == Scalar::F16)
    std::memcpy(at, &half, 2);
  else
    put_integer(scalar, int64_t(value), at);
}

void put_integer(Scalar scalar, int64_t value, std::byte* at) {
  if (is_float(scalar))
    put_real(scalar, double(value), at);
  else
    std::memcpy(at, &value, bytes_of(scalar));  // Glint runs only on little-endian hosts
}

bool put(Scalar scalar, const std::string& text, std::byte* at) {
  double real = 0;
  int64_t whole = 0;
  if (!is_float(scalar) && parse_integer(text, whole)) return put_integer(scalar, whole, at), true;
  if (!parse_real(text, real)) return false;
  if (!is_float(scalar) && !(real >= -0x1p63 && real < 0x1p63)) return false;
  put_real(scalar, real, at);
  return true;
}

uint64_t get_bits(Scalar scalar, const std::byte* at) {
  uint64_t bits = 0;
  std::memcpy(&bits, at, bytes_of(scalar));
  const bool is_signed = scalar == Scalar::I8 || scalar == Scalar::I16 || scalar == Scalar::I32;
  const uint32_t unused = 64 - 8 * bytes_of(scalar);
  return is_signed ? uint64_t(int64_t(bits << unused) >> unused) : bits;
}

double get_real(Scalar scalar, const std::byte* at) {
  const uint64_t bits = get_bits(scalar, at);
  if (scalar == Scalar::F16) return double(exec::from_half(uint16_t(bits)));
  float f = 0;
  double d = 0;
  std::memcpy(&f, at, scalar == Scalar::F32 ? 4 : 0);
  std::memcpy(&d, at, scalar == Scalar::F64 ? 8 : 0);
  if (scalar == Scalar::F32) return double(f);
  if (scalar == Scalar::F64) return d;
  const bool is_unsigned = scalar == Scalar::U64;
  return is_unsigned ? double(bits) : double(int64_t(bits));
}

std::string show(Scalar scalar, const std::byte* at) {
  if (is_float(scalar))
    return scalar == Scalar::F64 ? fmt::format("{}", get_real(scalar, at))
                                 : fmt::format("{}", float(get_real(scalar, at)));
  const uint64_t bits = get_bits(scalar, at);
  return scalar == Scalar::U64 ? fmt::format("{}", bits) : fmt::format("{}", int64_t(bits));
}

}  // namespace glint::amber
