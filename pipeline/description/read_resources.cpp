// Reads buffers, images and samplers.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>

#include "isa/descriptors.h"
#include "pipeline/description/data.h"
#include "pipeline/description/read.h"

namespace glint::pipeline {
namespace {

constexpr int64_t kMostBytes = int64_t{1} << 32;  // the largest buffer that the emulator is meant for

std::vector<Save> read_saves(TableReader& t) {
  std::vector<Save> out;
  const Value* value = t.take("save");
  for (const std::string& file : t.texts("save")) out.push_back({file, value->where});
  return out;
}

// Returns the name of a resource that its file does not name. It follows from the slot, if there is one.
std::string name_of_slot(const char* kind, const Slot& slot) {
  return slot.is_bound() ? fmt::format("{}_{}_{}", kind, slot.set.value_or(0), *slot.binding) : kind;
}

exec::Sampler read_sampler_keys(Reading& r, TableReader& t) {
  exec::Sampler out;
  const std::vector<std::string> filters{"nearest", "linear"};
  const auto filter = [&](const char* key, const std::string& fallback) {
    return t.name(key, fallback, filters) == "linear" ? exec::Filter::Linear : exec::Filter::Nearest;
  };
  const std::string both = t.name("filter", "linear", filters);
  out.mag = filter("mag_filter", both);
  out.min = filter("min_filter", both);
  out.mip = filter("mip_filter", "nearest");
  const std::vector<std::string> wraps{"repeat", "mirrored_repeat", "clamp_to_edge", "clamp_to_border",
                                       "mirror_clamp_to_edge"};
  const std::string all = t.name("wrap", "clamp_to_edge", wraps);
  const char* keys[] = {"wrap_u", "wrap_v", "wrap_w"};
  for (size_t i = 0; i < 3; ++i)
    out.wrap[i] =
        exec::Wrap(std::find(wraps.begin(), wraps.end(), t.name(keys[i], all, wraps)) - wraps.begin());
  const std::vector<double> border = t.numbers("border");
  if (border.size() > 4)
    r.errors.error(t.take("border")->where,
                   fmt::format("'border' has {} numbers, expected up to four", border.size()));
  for (size_t i = 0; i < std::min<size_t>(4, border.size()); ++i)
    out.border[i] = std::bit_cast<uint32_t>(float(border[i]));
  out.lod_bias = float(t.number("lod_bias", 0));
  out.min_lod = float(t.number("min_lod", 0));
  out.max_lod = float(t.number("max_lod", 1000));
  out.unnormalized = t.flag("unnormalized", false);
  out.max_anisotropy = float(t.number("max_anisotropy", 1));
  if (!(out.max_anisotropy >= 1 && out.max_anisotropy <= float(exec::kMaxAnisotropy)))
    r.errors.error(t.take("max_anisotropy")->where,
                   fmt::format("'max_anisotropy' is {}, expected a number from 1 to {}", out.max_anisotropy,
                               exec::kMaxAnisotropy));
  const std::vector<std::string> reductions{"mean", "min", "max"};
  out.reduction = exec::Reduction(
      std::find(reductions.begin(), reductions.end(), t.name("reduction", "mean", reductions)) -
      reductions.begin());
  const std::vector<std::string> compares{
      "never", "less", "equal", "less_or_equal", "greater", "not_equal", "greater_or_equal", "always"};
  out.compare = exec::Comparison(
      std::find(compares.begin(), compares.end(), t.name("compare", "never", compares)) - compares.begin());
  return out;
}

BufferDescription read_buffer(Reading& r, const Value& value) {
  TableReader t(value, "a buffer", r.errors);
  BufferDescription out;
  out.where = value.where;
  out.slot = read_slot(t);
  out.name = t.text("name", name_of_slot("buffer", out.slot));
  out.data = read_data(r, t, true);
  out.saves = read_saves(t);
  out.show = uint32_t(t.integer("show", 0, 0, 1 << 20));
  t.finish();
  return out;
}

// Reads everything of an image but its name and its place.
void read_image_keys(Reading& r, TableReader& t, ImageDescription& out) {
  for (const std::string& file : t.texts("file")) out.files.push_back(r.beside(file));
  if (t.take("format")) {
    out.format = format_named(t.text("format"));
    const std::string near = out.format ? "" : nearest(t.text("format"), format_names());
    if (!out.format)
      r.errors.error(
          t.take("format")->where, fmt::format("'{}' is not a format of texels", t.text("format")),
          near.empty() ? "for example rgba8_unorm, rgba32_float" : fmt::format("did you mean '{}'?", near));
  }
  const std::vector<uint32_t> size = t.sizes("size", 3);
  if (!size.empty()) out.size = {1, 1, 1};
  std::copy(size.begin(), size.end(), out.size.begin());
  out.layers = uint32_t(t.integer("layers", std::max<int64_t>(1, int64_t(out.files.size())), 1, 2048));
  out.samples = uint32_t(t.integer("samples", 1, 1, 64));
  out.mipmaps = t.flag("mipmaps", false);
  const bool has_data = t.take("data") != nullptr;
  out.data = t.numbers("data");
  out.init = has_data
                 ? "data"
                 : t.name("init", t.take("value") ? "value" : "zero", {"zero", "value", "checker", "random"});
  if (has_data && !out.files.empty())
    r.errors.error(out.where, fmt::format("image '{}' has both a file and data", out.name));
  const std::vector<double> color = t.numbers("value");
  for (size_t i = 0; i < 4; ++i) out.value[i] = i < color.size() ? color[i] : i == 3 ? 1 : 0;
  out.seed = uint64_t(t.integer("seed", 1, 0, INT64_MAX));
  out.sampler = read_sampler_keys(r, t);
  for (const char* key : {"filter", "mag_filter", "min_filter"}) out.has_filter |= t.take(key) != nullptr;
  const std::vector<double> border = t.numbers("border");
  std::copy_n(border.begin(), std::min<size_t>(4, border.size()), out.border.begin());
  out.saves = read_saves(t);
}

ImageDescription read_image(Reading& r, const Value& value) {
  TableReader t(value, "an image", r.errors);
  ImageDescription out;
  out.where = value.where;
  out.slot = read_slot(t);
  out.name = t.text("name", name_of_slot("image", out.slot));
  read_image_keys(r, t, out);
  t.finish();
  return out;
}

SamplerDescription read_sampler(Reading& r, const Value& value) {
  TableReader t(value, "a sampler", r.errors);
  SamplerDescription out;
  out.where = value.where;
  out.slot = read_slot(t);
  out.name = t.text("name", "sampler");
  out.sampler = read_sampler_keys(r, t);
  t.finish();
  return out;
}

// Reads what generators fill a buffer with. The numbers have to be those of its type.
void read_range(Reading& r, TableReader& t, DataSource& out) {
  const bool real = canonical(out.type)[0] == 'f';
  out.value = t.number("value", 0);
  out.low = t.number("low", 0);
  out.high = t.number("high", real ? 1 : 255);
  const auto check = [&](const char* key, double number) {
    const bool whole = number >= -0x1p63 && number < 0x1p63 && number == std::floor(number);
    if (!real && !(whole && fits(int64_t(number), out.type)))
      r.errors.error(t.where(), fmt::format("'{}' is {}, which is not a {}", key, number, out.type));
  };
  if (out.init == "value") check("value", out.value);
  if (out.init != "random") return;
  check("low", out.low), check("high", out.high);
  if (!(out.low <= out.high))
    r.errors.error(t.where(), fmt::format("'low' is {}, which is above 'high', {}", out.low, out.high));
}

}  // namespace

Slot read_slot(TableReader& t) {
  Slot slot;
  if (const auto set = t.optional_integer("set", 0, isa::kMaxSets - 1)) slot.set = uint32_t(*set);
  if (const auto binding = t.optional_integer("binding", 0, isa::kMaxBindings - 1))
    slot.binding = uint32_t(*binding);
  slot.element = uint32_t(t.integer("element", 0, 0, 1 << 20));
  if (slot.binding && !slot.set) slot.set = 0;
  return slot;
}

DataSource read_data(Reading& r, TableReader& t, bool is_buffer) {
  DataSource out;
  out.where = t.where();
  if (const Value* data = t.take("data")) out.data = *data;
  out.type = t.name("type", "u32", number_types());
  if (!is_buffer) return out;
  out.file = r.beside(t.text("file"));
  out.attribute = t.name("attribute", "", {"", "positions", "normals", "coordinates", "indices"});
  const std::string fallback = !out.attribute.empty() ? "mesh"
                               : !out.file.empty()    ? "file"
                               : t.take("value")      ? "value"
                                                      : "zero";
  out.init = t.name("init", fallback, {"zero", "value", "iota", "random", "file", "mesh"});
  read_range(r, t, out);
  out.seed = uint64_t(t.integer("seed", 1, 0, INT64_MAX));
  if (const auto bytes = t.optional_integer("bytes", 1, kMostBytes)) out.bytes = uint64_t(*bytes);
  const int64_t element = int64_t(bytes_of_number(out.type));
  if (const auto count = t.optional_integer("count", 1, kMostBytes / element))
    out.bytes = uint64_t(*count * element);
  if (out.init != "file" && out.init != "mesh" && !out.data && !out.bytes)
    r.errors.error(t.where(), "a buffer needs 'data', 'file', 'count' (of its type) or 'bytes'");
  if ((out.init == "file" || out.init == "mesh") && out.file.empty())
    r.errors.error(t.where(), "'file' is missing");
  return out;
}

KernelImage read_kernel_image(Reading& r, const Value& value) {
  static const std::vector<std::string> kShapes{"1d", "2d", "3d", "a1d", "a2d", "cube", "acube"};
  TableReader t(value, "an image", r.errors);
  KernelImage out;
  out.image.where = value.where;
  out.image.name = t.required_text("name");
  read_image_keys(r, t, out.image);
  const std::string shape = t.name("shape", "2d", kShapes);
  out.shape = isa::ImageShape(int(isa::ImageShape::D1) +
                              int(std::find(kShapes.begin(), kShapes.end(), shape) - kShapes.begin()));
  // Choice: what a description of a texture has in CUDA where nobody sets it (cudaTextureDesc).
  if (!out.image.has_filter) out.image.sampler.mag = out.image.sampler.min = exec::Filter::Nearest;
  out.image.has_filter = true;
  out.image.sampler.unnormalized = !t.flag("normalized", false);
  // Source: CUDA C++ Programming Guide, "Linear Filtering"; an H200 rounds to the nearest of these weights.
  constexpr uint32_t kWeightBits = 8;
  out.image.sampler.weight_bits = kWeightBits;
  t.finish();
  return out;
}

void read_resources(Reading& r, TableReader& root) {
  for (const Value* each : root.tables("buffer")) r.out.buffers.push_back(read_buffer(r, *each));
  for (const Value* each : root.tables("image")) r.out.images.push_back(read_image(r, *each));
  for (const Value* each : root.tables("sampler")) r.out.samplers.push_back(read_sampler(r, *each));
  read_structures(r, root);
}

std::vector<std::string> format_names() {
  std::vector<std::string> out;
  for (size_t i = 0; i < size_t(exec::kFirstBlockFormat); ++i)
    out.emplace_back(exec::info_of(exec::TexelFormat(i)).name);
  return out;
}

std::optional<exec::TexelFormat> format_named(const std::string& name) {
  if (name == "r11f_g11f_b10f") return exec::TexelFormat::R11g11b10Float;
  if (name == "rgb10_a2") return exec::TexelFormat::Rgb10a2Unorm;
  if (name == "rgb10_a2ui") return exec::TexelFormat::Rgb10a2Uint;
  for (size_t i = 0; i < size_t(exec::kFirstBlockFormat); ++i) {
    const std::string full(exec::info_of(exec::TexelFormat(i)).name);
    const size_t bar = full.find('_');
    const std::string channels = full.substr(0, bar),
                      kind = bar == std::string::npos ? "" : full.substr(bar + 1);
    const std::string glsl = kind == "unorm"   ? channels
                             : kind == "float" ? channels + "f"
                             : kind == "uint"  ? channels + "ui"
                             : kind == "sint"  ? channels + "i"
                                               : full;
    if (name == full || name == glsl) return exec::TexelFormat(i);
  }
  return {};
}

}  // namespace glint::pipeline
