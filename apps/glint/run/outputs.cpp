// Encodes what a run keeps.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/outputs.h"

#include <cstring>
#include <filesystem>
#include <fmt/format.h>

#include "pictures/encode.h"
#include "pictures/exr.h"
#include "pipeline/description/data.h"
#include "pipeline/description/pictures.h"
#include "report/picture/npy.h"

namespace glint::app {
namespace {

// Returns the short form of a type's name, such as "f32" for "float".
std::string plain(const std::string& type) {
  if (type == "float") return "f32";
  if (type == "double") return "f64";
  if (type == "uint") return "u32";
  if (type == "int") return "s32";
  return type[0] == 'i' ? "s" + type.substr(1) : type;
}

template <class T>
std::string as(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return fmt::format("{}", value);
}

std::string element_text(const std::string& type, const std::byte* at) {
  const uint32_t bytes = pipeline::bytes_of_number(type);
  if (type[0] == 'f') {
    if (bytes == 8) return as<double>(at);
    if (bytes == 4) return as<float>(at);
    uint16_t half;
    std::memcpy(&half, at, 2);
    return fmt::format("{}", exec::from_half(half));
  }
  const bool is_signed = type[0] == 's';
  if (bytes == 1) return is_signed ? as<int8_t>(at) : as<uint8_t>(at);
  if (bytes == 2) return is_signed ? as<int16_t>(at) : as<uint16_t>(at);
  if (bytes == 4) return is_signed ? as<int32_t>(at) : as<uint32_t>(at);
  return is_signed ? as<int64_t>(at) : as<uint64_t>(at);
}

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Returns an image as numbers of its own kind: floats, or integers, of which floats would lose bits.
std::string numbers_file(const std::string& ending, const exec::ImageView& view, uint32_t rows,
                         std::span<const std::byte> bytes) {
  const std::vector<uint32_t> words = pipeline::texels_as_words(view, bytes.data());
  const exec::Numeric numeric = exec::info_of(view.format).numeric;
  const char kind = numeric == exec::Numeric::Uint ? 'u' : numeric == exec::Numeric::Sint ? 's' : 'f';
  const std::string_view all = text_of(std::as_bytes(std::span(words)));
  if (ending == ".npy")
    return report::npy_bytes(fmt::format("<{}4", kind == 's' ? 'i' : kind),
                             fmt::format("({}, {}, 4)", rows, view.width), all);
  std::string out = "x,y,red,green,blue,alpha\n";
  const std::string type = fmt::format("{}32", kind);
  for (size_t i = 0; i + 4 <= words.size(); i += 4) {
    out += fmt::format("{},{}", i / 4 % view.width, i / 4 / view.width);
    for (size_t c = 0; c < 4; ++c)
      out += "," + element_text(type, std::as_bytes(std::span(&words[i + c], 1)).data());
    out += "\n";
  }
  return out;
}

std::string ending_of(const std::string& file) {
  return std::filesystem::path(file).extension().string();
}

// Returns what is wrong with the file's name, or "".
std::string wrong_with_output(const std::string& file, bool is_image) {
  const std::string ending = ending_of(file);
  if (file.find('/') != std::string::npos)
    return "the file goes to the run directory: give a name without folders";
  if (ending == ".npy" || ending == ".csv" || ending == ".raw" || ending == ".bin") return "";
  if (ending == ".png" || ending == ".pfm" || ending == ".exr")
    return is_image ? "" : "a buffer is not a picture: expected .npy, .csv or .raw";
  return is_image ? "expected .png, .pfm, .exr, .npy, .csv or .raw" : "expected .npy, .csv or .raw";
}

}  // namespace

void check_saves(const std::vector<pipeline::Save>& saves, bool is_image, Diagnostics& errors) {
  for (const pipeline::Save& save : saves)
    if (const std::string wrong = wrong_with_output(save.file, is_image); !wrong.empty())
      errors.error(save.where, fmt::format("cannot save to '{}'", save.file), wrong);
}

std::vector<std::string> save_image(const pipeline::ImageDescription& image, const exec::ImageView& view,
                                    const mem::AddressSpace& memory, const report::RunDirectory& directory,
                                    uint32_t threads) {
  std::vector<std::string> lines;
  const uint64_t bytes = view.bytes_before_level(1);
  const std::byte* const texels = memory.find(view.base, bytes);
  for (const pipeline::Save& save : image.saves) {
    directory.write(save.file, image_file(save.file, view, {texels, size_t(bytes)}, threads));
    lines.push_back(fmt::format("{:<10} {}", image.name, directory.path_of(save.file)));
  }
  return lines;
}

std::string first_numbers(const std::string& named, std::span<const std::byte> bytes, size_t count) {
  const std::string type = plain(named);
  const size_t each = pipeline::bytes_of_number(type);
  std::string out;
  for (size_t i = 0; i < count && (i + 1) * each <= bytes.size(); ++i)
    out += (i ? " " : "") + element_text(type, bytes.data() + i * each);
  return out;
}

std::string buffer_file(const std::string& file, const std::string& named, std::span<const std::byte> bytes) {
  const std::string type = plain(named), ending = ending_of(file);
  const size_t each = pipeline::bytes_of_number(type), count = bytes.size() / each;
  if (ending == ".npy") {
    const char kind = type[0] == 's' ? 'i' : type[0];
    return report::npy_bytes(fmt::format("{}{}{}", each == 1 ? '|' : '<', kind, each),
                             fmt::format("({},)", count), text_of(bytes.first(count * each)));
  }
  if (ending != ".csv") return std::string(text_of(bytes));
  std::string out = "value\n";
  for (size_t i = 0; i < count; ++i) out += element_text(type, bytes.data() + i * each) + "\n";
  return out;
}

std::string image_file(const std::string& file, const exec::ImageView& view, std::span<const std::byte> bytes,
                       uint32_t threads) {
  const std::string ending = ending_of(file);
  if (ending != ".png" && ending != ".pfm" && ending != ".exr" && ending != ".npy" && ending != ".csv")
    return std::string(text_of(bytes));
  const uint32_t rows = view.height * view.depth * view.layers;
  if (ending == ".npy" || ending == ".csv") return numbers_file(ending, view, rows, bytes);
  std::vector<float> texels = pipeline::texels_as_floats(view, bytes.data());
  if (ending == ".png") {
    // The bytes of a PNG are integers as they are, as those of a PNG become integers when an image is read.
    if (exec::is_integer(exec::info_of(view.format)))
      for (float& channel : texels) channel /= 255.0f;
    return pictures::png_bytes({view.width, rows, texels}, threads);
  }
  if (ending == ".pfm") return pictures::pfm_bytes({view.width, rows, texels}, threads);
  return pictures::exr_bytes({view.width, rows, texels});
}

}  // namespace glint::app
