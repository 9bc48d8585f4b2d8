// Reads BUFFER, IMAGE, STRUCT and SAMPLER: types, sizes and first contents.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>

#include "amber/parse.h"
#include "pipeline/description/pictures.h"

namespace glint::amber {
namespace {

Type find_type(Parsing& p, const std::string& name) {
  if (const auto found = p.script.structs.find(name); found != p.script.structs.end()) return found->second;
  if (std::optional<Type> type = type_named(name)) return *type;
  if (name.find('_') != std::string::npos && std::isupper(static_cast<unsigned char>(name[0])))
    p.unsupported("format " + name);
  p.wrong(fmt::format("there is no data type '{}'", name));
}

// Takes the length of an array from a type's name: "float[4]" becomes "float" and 4.
std::optional<uint32_t> take_count(Parsing& p, std::string& text) {
  const size_t open = text.find('[');
  if (open == std::string::npos) return std::nullopt;
  int64_t count = 0;
  if (text.back() != ']' || !parse_integer(text.substr(open + 1, text.size() - open - 2), count) ||
      count < 1 || count > 0x100'0000)
    p.wrong(fmt::format("'{}' has no valid array length", text));
  text.resize(open);
  return uint32_t(count);
}

Member parse_member(Parsing& p, std::string type) {
  Member member;
  member.count = take_count(p, type);
  member.type = std::make_shared<const Type>(find_type(p, type));
  member.name = p.tokens.word("the member's name");
  if (const auto count = take_count(p, member.name)) member.count = count;
  while (p.tokens.peek().is_word()) {
    const std::string name = p.tokens.next().text;
    if (name == "OFFSET")
      member.offset = p.tokens.number("the offset");
    else if (name == "ARRAY_STRIDE")
      member.array_stride = p.tokens.number("the array stride");
    else if (name == "MATRIX_STRIDE")
      member.matrix_stride = p.tokens.number("the matrix stride");
    else
      p.wrong(fmt::format("there is no attribute '{}' of members", name));
  }
  return member;
}

// Holds everything that a line on a buffer says before the buffer's contents are made.
struct Contents {
  std::string kind;  // FILL, SERIES_FROM, DATA, FILE or nothing
  std::vector<std::string> values;
  std::string file_kind, file;
  std::optional<uint64_t> count;
};

void parse_data(Parsing& p, Contents& contents) {
  Token token = p.tokens.next_after_line_ends();
  for (; token.is_word() && token.text != "END"; token = p.tokens.next_after_line_ends())
    contents.values.push_back(token.text);
  if (!token.is_word()) p.wrong("END is missing");
}

void parse_file(Parsing& p, Contents& contents) {
  contents.file_kind = p.tokens.word("the file");
  if (contents.file_kind == "TEXT" || contents.file_kind == "BINARY" || contents.file_kind == "PNG")
    contents.file = p.tokens.word("the file");
  else
    contents.file = contents.file_kind,
    contents.file_kind = contents.file.ends_with(".png") ? "PNG" : "BINARY";
  if (contents.file_kind != "TEXT") return;
  Tokens inside(p.read_file(contents.file), p.beside(contents.file));
  for (Token token = inside.next_after_line_ends(); token.is_word(); token = inside.next_after_line_ends())
    contents.values.push_back(token.text);
}

void parse_attribute(Parsing& p, const std::string& name, Buffer& buffer, Contents& contents, bool& std140) {
  if (name == "DATA_TYPE" || name == "FORMAT")
    buffer.type = find_type(p, p.tokens.word("the type"));
  else if (name == "STD140" || name == "STD430")
    std140 = name == "STD140";
  else if (name == "SIZE")
    contents.count = p.tokens.number("the size");
  else if (name == "WIDTH")
    buffer.size[0] = uint32_t(p.tokens.integer("the width", 1, 65536));
  else if (name == "HEIGHT")
    buffer.size[1] = uint32_t(p.tokens.integer("the height", 1, 65536));
  else if (name == "DEPTH")
    buffer.size[2] = uint32_t(p.tokens.integer("the depth", 1, 65536));
  else if (name == "MIP_LEVELS")
    buffer.levels = uint32_t(p.tokens.integer("the number of levels", 1, 17));
  else if (name == "DIM_1D" || name == "DIM_2D" || name == "DIM_3D")
    buffer.dimensions = uint32_t(name[4] - '0');
  else if (name == "SAMPLES")
    buffer.samples = uint32_t(p.tokens.integer("the number of samples", 1, 64));
  else if (name == "FILL")
    contents.kind = name, contents.values = {p.tokens.word("the value")};
  else if (name == "DATA")
    contents.kind = name, parse_data(p, contents);
  else if (name == "FILE")
    contents.kind = name, parse_file(p, contents);
  else if (name == "SERIES_FROM") {
    contents.kind = name, contents.values = {p.tokens.word("the first value")};
    if (!p.tokens.accept("INC_BY")) p.wrong("INC_BY is missing");
    contents.values.push_back(p.tokens.word("the step"));
  } else
    p.unsupported("attribute of buffers " + name);
}

void put_values(Buffer& buffer, const std::vector<std::string>& values) {
  const size_t each = buffer.layout.slots.size();
  for (size_t i = 0; i < values.size() && i / each < buffer.elements; ++i) {
    const Slot& slot = buffer.layout.slots[i % each];
    if (!put(slot.scalar, values[i], buffer.bytes.data() + i / each * buffer.layout.stride + slot.offset))
      throw UserError(buffer.where,
                      fmt::format("value {} of buffer '{}' is '{}', which is not a {}", i, buffer.name,
                                  values[i], is_float(slot.scalar) ? "number" : "integer"));
  }
}

void fill(Parsing& p, Buffer& buffer, const Contents& contents) {
  const bool is_series = contents.kind == "SERIES_FROM";
  double real = 0, real_step = 0;
  int64_t whole = 0, step = 0;
  const bool is_whole =
      parse_integer(contents.values[0], whole) && (!is_series || parse_integer(contents.values[1], step));
  if (!parse_real(contents.values[0], real) || (is_series && !parse_real(contents.values[1], real_step)))
    p.wrong(fmt::format("'{}' is not a number", contents.values[0]));
  for (uint64_t i = 0; i < buffer.elements; ++i)
    for (const Slot& slot : buffer.layout.slots) {
      std::byte* at = buffer.bytes.data() + i * buffer.layout.stride + slot.offset;
      if (is_whole && !is_float(slot.scalar))
        put_integer(slot.scalar, whole, at);
      else
        put_real(slot.scalar, real, at);
      if (is_series) whole = int64_t(uint64_t(whole) + uint64_t(step)), real += real_step;
    }
}

void load_picture(Parsing& p, Buffer& buffer, const Contents& contents) {
  if (!buffer.type.format) p.unsupported("pictures as " + buffer.type.name);
  pipeline::ImageDescription description;
  description.name = buffer.name, description.files = {p.beside(contents.file)},
  description.format = buffer.type.format, description.where = buffer.where;
  const pipeline::PictureMaker maker({&description, 1}, 1);
  pipeline::Picture picture = maker.make(description, {}, {1, 1, 1});
  buffer.size = {picture.view.width, picture.view.height, 1};
  buffer.elements = uint64_t{buffer.size[0]} * buffer.size[1];
  buffer.bytes = std::move(picture.texels);
}

uint64_t texels_of(const Buffer& buffer, uint32_t level) {
  uint64_t out = 1;
  for (uint32_t side : buffer.size) out *= std::max(1u, std::max(1u, side) >> level);
  return out;
}

void make(Parsing& p, Buffer& buffer, const Contents& contents) {
  const size_t each = buffer.layout.slots.size();
  std::string raw;
  if (contents.kind == "FILE" && contents.file_kind == "PNG") return load_picture(p, buffer, contents);
  if (contents.kind == "FILE" && contents.file_kind == "BINARY") raw = p.read_file(contents.file);
  if (contents.count)
    buffer.elements = *contents.count;
  else if (buffer.size[0])
    buffer.elements = texels_of(buffer, 0);
  else if (!raw.empty())
    buffer.elements = raw.size() / buffer.layout.stride;
  else
    buffer.elements =
        (contents.values.size() + each - 1) / each * (contents.kind == "DATA" || contents.kind == "FILE");
  if (buffer.elements == 0 && contents.kind.empty() && buffer.type.is_packed)
    p.unsupported("graphics: buffers as large as a framebuffer");
  if (buffer.elements == 0) p.wrong(fmt::format("'{}' has no size", buffer.name));
  if (buffer.size[0] && buffer.elements < texels_of(buffer, 0))
    p.wrong(
        fmt::format("'{}' has {} texels and SIZE {}", buffer.name, texels_of(buffer, 0), buffer.elements));
  if (buffer.samples > 1 && (buffer.levels > 1 || buffer.dimensions != 2))
    p.wrong(fmt::format("'{}' has several samples but is not DIM_2D with one level", buffer.name));
  if (buffer.samples > 1 && contents.kind != "" && contents.kind != "FILL")
    p.unsupported("contents of images of several samples, except FILL");
  uint64_t texels = buffer.elements *= buffer.samples;
  for (uint32_t level = 1; level < buffer.levels; ++level) texels += texels_of(buffer, level);
  if (texels > kMostBytes / buffer.layout.stride)
    p.wrong(fmt::format("'{}' has more than {} bytes", buffer.name, kMostBytes));
  buffer.bytes.resize(texels * buffer.layout.stride);
  if (!raw.empty())
    std::memcpy(buffer.bytes.data(), raw.data(), std::min(raw.size(), buffer.bytes.size()));
  else if (contents.kind == "FILL" || contents.kind == "SERIES_FROM")
    fill(p, buffer, contents);
  else
    put_values(buffer, contents.values);
}

exec::Wrap wrap_named(Parsing& p, const std::string& name) {
  const std::map<std::string, exec::Wrap> names{{"repeat", exec::Wrap::Repeat},
                                                {"mirrored_repeat", exec::Wrap::MirroredRepeat},
                                                {"clamp_to_edge", exec::Wrap::ClampToEdge},
                                                {"clamp_to_border", exec::Wrap::ClampToBorder},
                                                {"mirror_clamp_to_edge", exec::Wrap::MirrorClampToEdge}};
  const auto found = names.find(name);
  if (found == names.end()) p.wrong(fmt::format("there is no address mode '{}'", name));
  return found->second;
}

exec::Comparison comparison_named(Parsing& p, const std::string& name) {
  const std::vector<std::string> names{
      "never", "less", "equal", "less_or_equal", "greater", "not_equal", "greater_or_equal", "always"};
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) p.wrong(fmt::format("there is no comparison '{}'", name));
  return exec::Comparison(found - names.begin());
}

exec::Filter filter_named(Parsing& p, const std::string& name) {
  if (name != "nearest" && name != "linear") p.wrong(fmt::format("there is no filter '{}'", name));
  return name == "linear" ? exec::Filter::Linear : exec::Filter::Nearest;
}

// Returns the words of a VkBorderColor. It may be of floats or of integers, and the image's format decides
// how the words are read.
exec::Words border_named(Parsing& p, const std::string& name) {
  const uint32_t one = name.rfind("float", 0) == 0 ? 0x3f80'0000 : 1;
  if (name.ends_with("_transparent_black")) return {0, 0, 0, 0};
  if (name.ends_with("_opaque_black")) return {0, 0, 0, one};
  if (name.ends_with("_opaque_white")) return {one, one, one, one};
  p.wrong(fmt::format("there is no border colour '{}'", name));
}

}  // namespace

void parse_struct(Parsing& p) {
  Type type;
  type.name = p.tokens.word("the struct's name");
  if (p.tokens.accept("STRIDE")) type.stride = uint32_t(p.tokens.integer("the stride", 1, 0x100'0000));
  Token token = p.tokens.next_after_line_ends();
  for (; token.is_word() && token.text != "END"; token = p.tokens.next_after_line_ends())
    type.members.push_back(parse_member(p, token.text));
  if (!token.is_word()) p.wrong("END is missing");
  if (type.members.empty()) p.wrong(fmt::format("struct '{}' has no members", type.name));
  p.declare(p.script.structs, type.name, "struct") = type;
}

void parse_buffer(Parsing& p, bool is_image) {
  Buffer buffer;
  Contents contents;
  bool std140 = false;
  buffer.where = p.tokens.here(), buffer.is_image = is_image;
  buffer.name = p.tokens.word("the buffer's name");
  while (p.tokens.peek().is_word() && contents.kind != "DATA")
    parse_attribute(p, p.tokens.next().text, buffer, contents, std140);
  if (buffer.type.name.empty()) p.wrong(fmt::format("'{}' has no DATA_TYPE", buffer.name));
  buffer.layout = lay_out(buffer.type, std140);
  for (const Slot& slot : buffer.layout.slots)
    if (uint64_t{slot.offset} + bytes_of(slot.scalar) > buffer.layout.stride)
      p.wrong(
          fmt::format("the members of '{}' are past its {} bytes", buffer.type.name, buffer.layout.stride));
  if (buffer.layout.slots.size() > kMostNumbers)
    p.wrong(fmt::format("'{}' has more than {} numbers", buffer.type.name, kMostNumbers));
  if (is_image && !buffer.dimensions)
    p.wrong(fmt::format("image '{}' has no DIM_1D, DIM_2D or DIM_3D", buffer.name));
  if (is_image && !buffer.type.format) p.unsupported("images of " + buffer.type.name);
  for (uint32_t i = 0; i < 3 && buffer.size[0]; ++i) buffer.size[i] = std::max(1u, buffer.size[i]);
  make(p, buffer, contents);
  p.declare(p.script.buffers, buffer.name, "buffer") = std::move(buffer);
}

void parse_sampler(Parsing& p) {
  const std::string name = p.tokens.word("the sampler's name");
  exec::Sampler sampler;
  sampler.mag = sampler.min = exec::Filter::Nearest;
  sampler.wrap = {exec::Wrap::Repeat, exec::Wrap::Repeat, exec::Wrap::Repeat};
  sampler.max_lod = 1.0f;
  while (p.tokens.peek().is_word()) {
    const std::string key = p.tokens.next().text;
    if (key == "MAG_FILTER")
      sampler.mag = filter_named(p, p.tokens.word("the filter"));
    else if (key == "MIN_FILTER")
      sampler.min = filter_named(p, p.tokens.word("the filter"));
    else if (key.rfind("ADDRESS_MODE_", 0) == 0 && key.size() == 14 && key[13] >= 'U' && key[13] <= 'W')
      sampler.wrap[size_t(key[13] - 'U')] = wrap_named(p, p.tokens.word("the address mode"));
    else if (key == "BORDER_COLOR")
      sampler.border = border_named(p, p.tokens.word("the border colour"));
    else if (key == "MIN_LOD")
      sampler.min_lod = float(p.tokens.real("the level"));
    else if (key == "MAX_LOD")
      sampler.max_lod = float(p.tokens.real("the level"));
    else if (key == "NORMALIZED_COORDS")
      sampler.unnormalized = false;
    else if (key == "UNNORMALIZED_COORDS")
      sampler.unnormalized = true, sampler.min_lod = sampler.max_lod = 0;
    else if (key == "COMPARE")
      sampler.compare = comparison_named(p, p.tokens.word("the comparison"));
    else
      p.unsupported("attribute of samplers " + key);
  }
  p.declare(p.script.samplers, name, "sampler") = sampler;
}

}  // namespace glint::amber
