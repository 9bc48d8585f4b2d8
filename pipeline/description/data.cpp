// Writes numbers to the places that a layout gives, and fills buffers.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/data.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "pipeline/description/mesh.h"

namespace glint::pipeline {
namespace {

using frontend::BlockType;

void flatten(const Value& value, std::vector<const Value*>& out) {
  if (value.kind == Value::Kind::List)
    for (const Value& each : value.list) flatten(each, out);
  else
    out.push_back(&value);
}

template <class T>
void store(T value, std::byte* at) {
  std::memcpy(at, &value, sizeof value);
}

// Writes members by name, along the layout.
class Members {
 public:
  Members(const AddressOf& address, Diagnostics& errors) : address_(address), errors_(errors) {}
  std::vector<std::byte> bytes;

  void write(const Value& value, const BlockType& type, uint64_t at, const std::string& name) {
    switch (type.kind) {
      case BlockType::Kind::Struct:
        return write_struct(value, type, at, name);
      case BlockType::Kind::Array:
        return write_array(value, type, at, name);
      case BlockType::Kind::Numbers:
        break;
    }
    std::vector<const Value*> numbers;
    flatten(value, numbers);
    write_numbers(numbers, 0, value, type, at, name);
  }

 private:
  void write_struct(const Value& value, const BlockType& type, uint64_t at, const std::string& name) {
    if (value.kind != Value::Kind::Table)
      return errors_.error(value.where, fmt::format("'{}' must be a table of its members", name));
    std::vector<std::string> names;
    for (const frontend::BlockMember& member : type.members) names.push_back(member.name);
    for (const auto& [key, each] : value.table) {
      const auto found = std::find(names.begin(), names.end(), key);
      if (found == names.end()) {
        const std::string near = nearest(key, names);
        errors_.error(each.where, fmt::format("the shader's block has no member '{}'", key),
                      near.empty() ? fmt::format("it has {}", fmt::join(names, ", "))
                                   : fmt::format("did you mean '{}'?", near));
        continue;
      }
      const frontend::BlockMember& member = type.members[size_t(found - names.begin())];
      write(each, member.type, at + member.offset, key);
    }
  }

  void write_array(const Value& value, const BlockType& type, uint64_t at, const std::string& name) {
    if (value.kind != Value::Kind::List)
      return errors_.error(value.where, fmt::format("'{}' must be a list, because it is an array", name));
    const BlockType& element = type.element[0];
    const bool flat = element.kind == BlockType::Kind::Numbers && !value.list.empty() &&
                      value.list[0].kind != Value::Kind::List;
    const size_t each = flat ? element.offsets.size() : 1;
    const size_t count = value.list.size() / std::max<size_t>(1, each);
    if (flat && value.list.size() % each)
      return errors_.error(value.where, fmt::format("'{}' has {} numbers, expected a multiple of {}", name,
                                                    value.list.size(), each));
    if (type.count && count > type.count)
      return errors_.error(value.where, fmt::format("'{}' has {} elements, and the shader's array has {}",
                                                    name, count, type.count));
    std::vector<const Value*> numbers;
    if (flat) flatten(value, numbers);
    for (size_t i = 0; i < count; ++i)
      if (flat)
        write_numbers(std::vector(numbers.begin() + long(i * each), numbers.begin() + long((i + 1) * each)),
                      0, value, element, at + i * type.stride, name);
      else
        write(value.list[i], element, at + i * type.stride, fmt::format("{}[{}]", name, i));
    if (bytes.size() < at + count * type.stride) bytes.resize(at + count * type.stride);
  }

  void write_numbers(const std::vector<const Value*>& numbers, size_t, const Value& value,
                     const BlockType& type, uint64_t at, const std::string& name) {
    if (numbers.size() != type.offsets.size())
      return errors_.error(value.where, fmt::format("'{}' has {} numbers, the shader's member {} of type {}",
                                                    name, numbers.size(), type.offsets.size(), type.number));
    if (bytes.size() < at + type.bytes) bytes.resize(at + type.bytes);
    for (size_t i = 0; i < numbers.size(); ++i)
      if (!put_number(type.number, *numbers[i], address_, bytes.data() + at + type.offsets[i]))
        return errors_.error(numbers[i]->where, fmt::format("'{}' must be {}", name, type.number));
  }

  const AddressOf& address_;
  Diagnostics& errors_;
};

bool is_type(const std::string& name) {
  return std::find(number_types().begin(), number_types().end(), name) != number_types().end();
}

std::string text_of(const Value& value) {
  if (value.kind == Value::Kind::Integer) return fmt::format("{}", value.whole);
  if (value.kind == Value::Kind::Real) return fmt::format("{}", value.real);
  return value.kind == Value::Kind::Text ? fmt::format("'{}'", value.text) : "this";
}

std::string note_of(const Value& value) {
  if (value.kind == Value::Kind::Real)
    return "numbers with a fraction need a type of floats: type = \"f32\", or { f32 = [...] }";
  return value.kind == Value::Kind::Text
             ? "only a u64 may be a text, the name of a buffer whose address it is"
             : "";
}

void append_typed(const Value& list, const std::string& type, const AddressOf& address,
                  std::vector<std::byte>& out, Diagnostics& errors) {
  std::vector<const Value*> numbers;
  flatten(list, numbers);
  const size_t each = bytes_of_number(type);
  for (const Value* number : numbers) {
    out.resize(out.size() + each);
    if (!put_number(type, *number, address, out.data() + out.size() - each))
      return errors.error(number->where, fmt::format("{} is not a {}", text_of(*number), type),
                          note_of(*number));
  }
}

std::vector<std::byte> inline_bytes(const DataSource& source, const BlockType* block,
                                    const AddressOf& address, Diagnostics& errors) {
  std::vector<std::byte> out;
  const auto chunk = [&](const Value& table) {
    for (const auto& [type, numbers] : table.table) append_typed(numbers, type, address, out, errors);
  };
  const auto is_chunk = [](const Value& v) {
    return v.kind == Value::Kind::Table && !v.table.empty() &&
           std::all_of(v.table.begin(), v.table.end(), [](const auto& e) { return is_type(e.key); });
  };
  const Value& data = source.data;
  if (data.kind == Value::Kind::List && !data.list.empty() &&
      std::all_of(data.list.begin(), data.list.end(), is_chunk)) {
    for (const Value& each : data.list) chunk(each);
  } else if (is_chunk(data)) {
    chunk(data);
  } else if (data.kind == Value::Kind::Table) {
    if (!block || block->members.empty()) {
      errors.error(data.where, "no shader declares a block here, so members cannot be named",
                   "give typed numbers: data = { f32 = [1, 2] }");
      return out;
    }
    Members members(address, errors);
    members.bytes.resize(block->bytes);
    members.write(data, *block, 0, "data");
    return members.bytes;
  } else {
    append_typed(data, source.type, address, out, errors);
  }
  return out;
}

void fill(const DataSource& source, std::vector<std::byte>& out) {
  const size_t each = bytes_of_number(source.type), bits = 8 * each;
  const bool real = canonical(source.type)[0] == 'f';
  RandomNumbers random(source.seed);
  Value value;
  value.kind = real ? Value::Kind::Real : Value::Kind::Integer;
  const AddressOf none = [](const std::string&) { return uint64_t{0}; };
  for (size_t i = 0; i < out.size() / each; ++i) {
    if (source.init == "iota") {
      value.real = double(i), value.whole = int64_t(bits >= 64 ? i : i & ((uint64_t{1} << bits) - 1));
    } else if (source.init == "value") {
      value.real = source.value, value.whole = int64_t(source.value);
    } else if (real) {
      value.real = source.low + (source.high - source.low) * random.next_unit();
    } else {
      const uint64_t range = uint64_t(source.high - source.low) + 1;
      value.whole = int64_t(source.low) + int64_t(random.next_bits() % (range ? range : 1));
      value.real = double(value.whole);
    }
    put_number(source.type, value, none, out.data() + i * each);
  }
}

std::vector<std::byte> file_bytes(const DataSource& source, Diagnostics& errors) {
  std::ifstream in(source.file, std::ios::binary);
  if (!in) {
    errors.error(source.where, fmt::format("cannot read '{}'", source.file));
    return {};
  }
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::byte> out(text.size());
  std::memcpy(out.data(), text.data(), text.size());
  return out;
}

}  // namespace

std::string canonical(const std::string& type) {
  if (type == "float") return "f32";
  if (type == "double") return "f64";
  if (type == "uint") return "u32";
  if (type == "int") return "s32";
  if (type[0] == 'i') return "s" + type.substr(1);
  return type;
}

bool fits(int64_t whole, const std::string& type) {
  const uint32_t bits = 8 * bytes_of_number(type);
  return bits == 64 || (whole >= -(int64_t{1} << (bits - 1)) && whole < int64_t{1} << bits);
}

const std::vector<std::string>& number_types() {
  static const std::vector<std::string> kTypes{"u8",  "s8",  "u16",  "s16",   "u32",   "s32", "u64",
                                               "s64", "f16", "f32",  "f64",   "i8",    "i16", "i32",
                                               "i64", "int", "uint", "float", "double"};
  return kTypes;
}

uint32_t bytes_of_number(const std::string& type) {
  return uint32_t(std::stoul(canonical(type).substr(1))) / 8;
}

bool put_number(const std::string& name, const Value& value, const AddressOf& address, std::byte* at) {
  const std::string type = canonical(name);
  if (value.kind == Value::Kind::Text) {
    const uint64_t found = bytes_of_number(type) == 8 && type[0] != 'f' ? address(value.text) : 0;
    if (found) store(found, at);
    return found != 0;
  }
  if (value.kind != Value::Kind::Bool && !value.is_number()) return false;
  const double real = value.kind == Value::Kind::Bool ? double(value.flag) : value.real;
  if (type == "f32") return store(float(real), at), true;
  if (type == "f64") return store(real, at), true;
  if (type == "f16") return store(exec::to_half(float(real)), at), true;
  if (value.kind == Value::Kind::Real) return false;
  const int64_t whole = value.kind == Value::Kind::Bool ? int64_t(value.flag) : value.whole;
  if (!fits(whole, type)) return false;
  std::memcpy(at, &whole, bytes_of_number(type));  // On a little-endian machine this takes the low bits.
  return true;
}

std::vector<std::byte> bytes_of(const DataSource& source, const BlockType* block, const AddressOf& address,
                                Diagnostics& errors) {
  std::vector<std::byte> out;
  if (source.data)
    out = inline_bytes(source, block, address, errors);
  else if (source.init == "file")
    out = file_bytes(source, errors);
  else if (source.init == "mesh")
    out = mesh_attribute(source);
  if (source.bytes && out.size() > *source.bytes)
    errors.error(source.where,
                 fmt::format("the data have {} bytes, and the buffer has {}", out.size(), *source.bytes));
  if (source.bytes) out.resize(size_t(*source.bytes));
  if (!source.data && (source.init == "iota" || source.init == "value" || source.init == "random"))
    fill(source, out);
  return out;
}

uint64_t RandomNumbers::next_bits() {
  state_ ^= state_ >> 12;
  state_ ^= state_ << 25;
  state_ ^= state_ >> 27;
  return (state_ * 0x2545'f491'4f6c'dd1dull) >> 11;
}

}  // namespace glint::pipeline
