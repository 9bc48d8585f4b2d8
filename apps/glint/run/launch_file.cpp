// Reads launch files.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/launch_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "apps/glint/run/kernel_images.h"
#include "base/toml_text.h"
#include "pipeline/description/value.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

const std::vector<std::string> kTypes{"u8", "s8", "u16", "s16", "u32", "s32", "u64", "s64", "f32", "f64"};

// Choice: the heap lies in the host's memory, so it has a limit.
constexpr int64_t kMostHeapBytes = int64_t{1} << 32;

bool is_type(std::string_view name) {
  return std::find(kTypes.begin(), kTypes.end(), name) != kTypes.end();
}
size_t bytes_of_type(const std::string& type) {
  return std::stoul(type.substr(1)) / 8;
}

// Returns the bytes of a number as that type. Integers keep their low bits.
std::vector<std::byte> number_bytes(const std::string& type, double real, int64_t whole) {
  if (type == "f32") return pipeline::KernelWorld::argument(float(real));
  if (type == "f64") return pipeline::KernelWorld::argument(real);
  std::vector<std::byte> out = pipeline::KernelWorld::argument(whole);
  out.resize(bytes_of_type(type));
  return out;
}

// Returns the next number of xorshift64*, which gives the same numbers on every machine.
uint64_t next_random(uint64_t& state) {
  state ^= state >> 12;
  state ^= state << 25;
  state ^= state >> 27;
  return state * 0x2545'f491'4f6c'dd1dull;
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {}

  LaunchFile run() {
    const toml::table root = toml_of_file(path_);
    reject_others(root,
                  {"kernel", "entry", "grid", "block", "shared_bytes", "stack_bytes", "heap_bytes",
                   "contract", "argument", "launch", "image"},
                  "a launch file");
    LaunchFile out;
    if (root.contains("image")) out.images = read_kernel_images(path_);
    for (size_t i = 0; i < out.images.size(); ++i) handle_of_[out.images[i].image.name] = i;
    KernelLaunch common;
    common.where = {path_, 0, 0};
    launch(root, common);
    if (common.kernel.empty())
      errors_.error({path_, 0, 0},
                    "'kernel' is missing: it is the path of the PTX file, relative to this file's folder");
    if (const toml::node* list = root.get("launch"); !list)
      out.launches.push_back(std::move(common));
    else if (!list->is_array_of_tables() || list->as_array()->empty())
      errors_.error(where(*list), "'launch' must be tables: [[launch]]");
    else
      for (const toml::node& each : *list->as_array())
        out.launches.push_back(listed(*each.as_table(), common));
    errors_.throw_if_errors();
    return out;
  }

 private:
  // Reads what a launch has in common with a file. What stands in `out` already are the defaults.
  void launch(const toml::table& table, KernelLaunch& out) {
    if (const auto kernel = text(table, "kernel")) {
      out.kernel = beside(*kernel), out.entry = "";
      out.kernel_where = where(*table.get("kernel"));
    }
    out.entry = text(table, "entry").value_or(out.entry);
    out.contract = flag(table, "contract", out.contract);
    size_of(table, "grid", out.grid.grid);
    size_of(table, "block", out.grid.block);
    out.grid.dynamic_shared_bytes =
        uint32_t(integer(table, "shared_bytes", 0, uint32_t(-1)).value_or(out.grid.dynamic_shared_bytes));
    if (const auto heap = integer(table, "heap_bytes", 0, kMostHeapBytes)) out.heap_bytes = uint64_t(*heap);
    if (const auto stack = integer(table, "stack_bytes", 0, pipeline::kMostStackBytes))
      out.grid.stack_bytes = uint32_t(*stack);
    const toml::node* const list = table.get("argument");
    if (!list) return;
    out.arguments.clear();
    if (!list->is_array_of_tables())
      errors_.error(where(*list), "'argument' must be tables, such as [[argument]] or [[launch.argument]]");
    else
      for (const toml::node& each : *list->as_array()) out.arguments.push_back(argument(*each.as_table()));
  }

  // Reads one of several launches, whose defaults are those of the file. Its name is also that of a folder.
  KernelLaunch listed(const toml::table& table, const KernelLaunch& common) {
    reject_others(table,
                  {"name", "kernel", "entry", "grid", "block", "shared_bytes", "stack_bytes", "contract",
                   "caches", "argument"},
                  "a launch");
    KernelLaunch out = common;
    out.where = where(table);
    out.name = text(table, "name").value_or("");
    if (out.name.empty() || out.name.find_first_of("/\\") != std::string::npos || out.name.starts_with('.'))
      errors_.error(out.where,
                    "a launch needs a 'name'. It names a folder, so it has no slash and no dot at its start");
    const std::string caches = text(table, "caches").value_or("cold");
    if (caches != "cold" && caches != "warm")
      errors_.error(out.where, "'caches' must be \"cold\" or \"warm\"");
    out.warm = caches == "warm";
    if (!table.contains("argument"))
      for (LaunchArgument& each : out.arguments) each.is_known = each.is_buffer && known_.count(each.name);
    launch(table, out);
    for (const LaunchArgument& each : out.arguments)
      if (each.is_buffer) known_.insert(each.name);
    return out;
  }

  SourceLocation where(const toml::node& node) const {
    return {path_, int(node.source().begin.line), int(node.source().begin.column)};
  }
  std::string beside(const std::string& file) const {
    return file.empty() ? file : (std::filesystem::path(path_).parent_path() / file).string();
  }

  void reject_others(const toml::table& table, const std::vector<std::string>& known,
                     const std::string& what) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      const std::string near = nearest(name, known);
      errors_.error({path_, int(key.source().begin.line), int(key.source().begin.column)},
                    fmt::format("'{}' is not a key of {}", name, what),
                    near.empty() ? "" : fmt::format("did you mean '{}'?", near));
    }
  }

  std::optional<std::string> text(const toml::table& table, const char* key) {
    const toml::node* node = table.get(key);
    if (!node) return {};
    if (!node->is_string()) errors_.error(where(*node), fmt::format("'{}' must be a string", key));
    return node->value<std::string>();
  }
  std::optional<int64_t> integer(const toml::table& table, const char* key, int64_t least, int64_t most) {
    const toml::node* node = table.get(key);
    if (!node) return {};
    const auto value = node->is_integer() ? node->value<int64_t>() : std::nullopt;
    if (value && *value >= least && *value <= most) return value;
    errors_.error(where(*node), fmt::format("'{}' must be a whole number from {} to {}", key, least, most));
    return {};
  }
  bool flag(const toml::table& table, const char* key, bool fallback) {
    const toml::node* node = table.get(key);
    if (node && !node->is_boolean())
      errors_.error(where(*node), fmt::format("'{}' must be true or false", key));
    return node ? node->value<bool>().value_or(fallback) : fallback;
  }
  std::optional<double> number(const toml::table& table, const char* key) {
    const toml::node* node = table.get(key);
    if (!node) return {};
    if (!node->is_number()) errors_.error(where(*node), fmt::format("'{}' must be a number", key));
    return node->value<double>();
  }

  // Reads one number, or up to three.
  void size_of(const toml::table& table, const char* key, std::array<uint32_t, 3>& out) {
    const toml::node* node = table.get(key);
    if (!node) return;
    const auto fail = [&] {
      errors_.error(where(*node),
                    fmt::format("'{}' must be a whole number, or a list of up to three, each from 1 to {}",
                                key, pipeline::kMostOfAxis));
    };
    const auto axis = [&](const toml::node& n, size_t i) {
      const auto value = n.is_integer() ? n.value<int64_t>() : std::nullopt;
      if (value && *value >= 1 && *value <= pipeline::kMostOfAxis)
        out[i] = uint32_t(*value);
      else
        fail();
    };
    const toml::array* list = node->as_array();
    if (!list) return axis(*node, 0);
    if (list->empty() || list->size() > 3) return fail();
    for (size_t i = 0; i < list->size(); ++i) axis(*list->get(i), i);
  }

  LaunchArgument argument(const toml::table& table) {
    LaunchArgument out;
    out.where = where(table);
    if (table.contains("buffer")) {
      buffer(table, out);
      return out;
    }
    if (table.contains("texture") || table.contains("surface")) return image_handle(table, std::move(out));
    reject_others(table, kTypes, "a number, which is written TYPE = VALUE");
    for (const std::string& type : kTypes) {
      const auto value = number(table, type.c_str());
      if (!value) continue;
      const toml::node& node = *table.get(type);
      if (type[0] != 'f' && !node.is_integer())
        errors_.error(where(node), fmt::format("'{}' must be a whole number", type));
      out.bytes = number_bytes(type, *value, node.value<int64_t>().value_or(0));
      return out;
    }
    errors_.error(out.where,
                  "an argument is a number (u32 = 7), a buffer (buffer = \"name\"), or an image (texture or "
                  "surface = \"name\")");
    return out;
  }

  // Reads a handle. Textures and surfaces of one image have the same one.
  LaunchArgument image_handle(const toml::table& table, LaunchArgument out) {
    const char* const key = table.contains("texture") ? "texture" : "surface";
    reject_others(table, {key}, "a handle, which is written texture = \"name\" or surface = \"name\"");
    const std::string name = text(table, key).value_or("");
    const auto handle = handle_of_.find(name);
    if (handle == handle_of_.end())
      errors_.error(out.where, fmt::format("there is no [[image]] with the name '{}'", name));
    out.bytes = pipeline::KernelWorld::argument(uint64_t(handle == handle_of_.end() ? 0 : handle->second));
    return out;
  }

  void buffer(const toml::table& table, LaunchArgument& out) {
    reject_others(
        table,
        {"buffer", "type", "count", "bytes", "init", "value", "seed", "low", "high", "file", "save", "show"},
        "a buffer");
    out.is_buffer = true;
    out.name = text(table, "buffer").value_or("");
    out.is_known = known_.count(out.name) != 0;
    if (out.is_known && table.size() == 1) return;
    if (out.is_known)
      errors_.error(out.where,
                    fmt::format("buffer '{}' is there already: a later launch names it alone", out.name));
    out.type = text(table, "type").value_or("u8");
    if (!is_type(out.type)) {
      errors_.error(out.where,
                    fmt::format("'{}' is not a type; the types are {}", out.type, fmt::join(kTypes, " ")));
      out.type = "u8";
    }
    out.save = flag(table, "save", false);
    out.show = uint32_t(integer(table, "show", 0, 1 << 20).value_or(0));
    constexpr int64_t kMostBytes = int64_t{1} << 32;
    const size_t element = bytes_of_type(out.type);
    std::optional<int64_t> bytes = integer(table, "bytes", 1, kMostBytes);
    if (const auto count = integer(table, "count", 1, kMostBytes / int64_t(element)))
      bytes = *count * int64_t(element);
    fill(table, out, bytes, element);
  }

  void fill(const toml::table& table, LaunchArgument& out, std::optional<int64_t> bytes, size_t element) {
    const std::string init = text(table, "init")
                                 .value_or(table.contains("file")    ? "file"
                                           : table.contains("value") ? "value"
                                                                     : "zero");
    if (init == "file") return fill_from_file(table, out, bytes);
    if (!bytes) {
      errors_.error(out.where, "a buffer needs 'count' (of its type) or 'bytes'");
      bytes = 0;
    }
    out.bytes.resize(size_t(*bytes));
    const size_t count = out.bytes.size() / element;
    const bool real = out.type[0] == 'f';
    const double low = number(table, "low").value_or(0),
                 high = number(table, "high").value_or(real ? 1 : 255);
    const double value = number(table, "value").value_or(0);
    uint64_t state =
        uint64_t(integer(table, "seed", 0, INT64_MAX).value_or(1)) * 0x9e37'79b9'7f4a'7c15ull + 1;
    const auto element_at = [&](size_t i) {
      if (init == "iota") return number_bytes(out.type, double(i), int64_t(i));
      if (init == "value") return number_bytes(out.type, value, int64_t(value));
      const uint64_t r = next_random(state) >> 11;
      const double unit = double(r) * 0x1p-53;
      if (real) return number_bytes(out.type, low + (high - low) * unit, 0);
      const uint64_t range = uint64_t(high - low) + 1;
      return number_bytes(out.type, 0, int64_t(low) + int64_t(r % (range ? range : 1)));
    };
    if (init == "zero") return;
    if (init != "iota" && init != "value" && init != "random")
      return errors_.error(
          out.where,
          fmt::format("'{}' is not a way to fill a buffer; the ways are zero, value, iota, random and file",
                      init));
    for (size_t i = 0; i < count; ++i) {
      const std::vector<std::byte> one = element_at(i);
      std::copy(one.begin(), one.end(), out.bytes.begin() + std::ptrdiff_t(i * element));
    }
  }

  void fill_from_file(const toml::table& table, LaunchArgument& out, std::optional<int64_t> bytes) {
    const std::string file = beside(text(table, "file").value_or(""));
    const std::optional<std::string> read = setup::text_of_file(file);
    if (!read) return errors_.error(out.where, fmt::format("cannot read '{}'", file));
    const std::string& data = *read;
    out.bytes.resize(bytes ? size_t(*bytes) : data.size());
    if (data.size() > out.bytes.size() || out.bytes.empty())
      return errors_.error(out.where, fmt::format("'{}' has {} bytes, and the buffer has {}", file,
                                                  data.size(), out.bytes.size()));
    std::memcpy(out.bytes.data(), data.data(), data.size());
  }

  const std::string path_;
  std::map<std::string, uint64_t> handle_of_;  // by name of an image
  std::set<std::string> known_;                // buffers of the launches that were read
  Diagnostics errors_;
};

template <class T>
std::string number_text(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return fmt::format("{}", value);
}

}  // namespace

LaunchFile read_launch(const std::string& path) {
  return Reader(path).run();
}

std::string first_values(const std::string& type, const std::byte* data, size_t bytes, uint32_t count) {
  const size_t element = bytes_of_type(type);
  std::string out;
  for (size_t i = 0; i < count && (i + 1) * element <= bytes; ++i) {
    const std::byte* at = data + i * element;
    out += i ? " " : "";
    if (type == "f32")
      out += number_text<float>(at);
    else if (type == "f64")
      out += number_text<double>(at);
    else if (type == "u8")
      out += number_text<uint8_t>(at);
    else if (type == "s8")
      out += number_text<int8_t>(at);
    else if (type == "u16")
      out += number_text<uint16_t>(at);
    else if (type == "s16")
      out += number_text<int16_t>(at);
    else if (type == "u32")
      out += number_text<uint32_t>(at);
    else if (type == "s32")
      out += number_text<int32_t>(at);
    else if (type == "u64")
      out += number_text<uint64_t>(at);
    else
      out += number_text<int64_t>(at);
  }
  return out;
}

}  // namespace glint::app
