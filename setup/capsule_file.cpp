// Writes capsules (launches of applications with all that they can reach) to files, and reads them.
// SPDX-License-Identifier: Apache-2.0
#include "setup/capsule_file.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>
#include <zstd.h>

#include "base/check.h"
#include "base/diagnostics.h"
#include "base/file_store.h"
#include "base/regular_file.h"
#include "setup/capsule_structures.h"

namespace glint::setup {
namespace {

using pipeline::Capsule;

constexpr std::string_view kMark = "glint capsule ";
constexpr std::string_view kHead = "glint capsule 2\n";

// JSON has no infinity, so floats are kept as bits.
uint32_t bits_of(float value) {
  return std::bit_cast<uint32_t>(value);
}
float float_of(const Json& json) {
  return std::bit_cast<float>(json.get<uint32_t>());
}

Json json_of(const exec::Sampler& s) {
  return {int(s.mag),         int(s.min),
          int(s.mip),         int(s.wrap[0]),
          int(s.wrap[1]),     int(s.wrap[2]),
          s.border,           bits_of(s.lod_bias),
          bits_of(s.min_lod), bits_of(s.max_lod),
          s.unnormalized,     int(s.compare),
          s.unbound,          bits_of(s.max_anisotropy),
          int(s.reduction)};
}
exec::Sampler sampler_of(const Json& json) {
  exec::Sampler s;
  s.mag = exec::Filter(json.at(0).get<int>()), s.min = exec::Filter(json.at(1).get<int>());
  s.mip = exec::Filter(json.at(2).get<int>());
  for (size_t i = 0; i < 3; ++i) s.wrap[i] = exec::Wrap(json.at(3 + i).get<int>());
  s.border = json.at(6), s.lod_bias = float_of(json.at(7));
  s.min_lod = float_of(json.at(8)), s.max_lod = float_of(json.at(9));
  s.unnormalized = json.at(10), s.compare = exec::Comparison(json.at(11).get<int>());
  s.unbound = json.at(12);
  // Older capsules have isotropic samplers, and filters that are means.
  if (json.size() > 13) s.max_anisotropy = float_of(json.at(13));
  if (json.size() > 14) s.reduction = exec::Reduction(json.at(14).get<int>());
  return s;
}

Json json_of(const exec::ImageView& v) {
  Json swizzle = Json::array();
  for (const exec::Component each : v.swizzle) swizzle.push_back(int(each));
  return {{"name", v.name},
          {"format", exec::info_of(v.format).name},
          {"number", int(v.format)},
          {"size", {v.width, v.height, v.depth, v.layers, v.levels, v.samples}},
          {"base", v.base},
          {"shape", int(v.shape)},
          {"sampler", json_of(v.sampler)},
          {"bound", v.is_bound},
          {"null", v.is_null},
          {"layer", {v.first_layer, v.stored_layers}},
          {"swizzle", swizzle}};
}
exec::ImageView image_of(const Json& json) {
  exec::ImageView v;
  v.name = json.at("name"), v.format = exec::TexelFormat(json.at("number").get<int>());
  if (exec::info_of(v.format).name != json.at("format").get<std::string>()) throw std::out_of_range(kDamaged);
  const Json& size = json.at("size");
  v.width = size.at(0), v.height = size.at(1), v.depth = size.at(2), v.layers = size.at(3);
  v.levels = size.at(4), v.samples = size.at(5);
  v.base = json.at("base"), v.shape = isa::ImageShape(json.at("shape").get<int>());
  v.sampler = sampler_of(json.at("sampler")), v.is_bound = json.at("bound");
  v.is_null = json.value("null", false);
  v.first_layer = json.at("layer").at(0), v.stored_layers = json.at("layer").at(1);
  for (size_t i = 0; i < 4; ++i) v.swizzle[i] = exec::Component(json.at("swizzle").at(i).get<int>());
  return v;
}

Json json_of(const pipeline::BoundResources& bound) {
  Json out = {{"set", bound.place.first}, {"binding", bound.place.second}};
  Json elements = Json::array();
  if (const auto* buffers = std::get_if<std::vector<pipeline::BufferRange>>(&bound.elements)) {
    for (const auto& each : *buffers) elements.push_back({each.address, each.bytes});
    out["buffers"] = elements;
  } else if (const auto* images = std::get_if<std::vector<exec::ImageView>>(&bound.elements)) {
    for (const auto& each : *images) elements.push_back(json_of(each));
    out["images"] = elements;
  } else {
    for (const auto& each : std::get<std::vector<exec::Sampler>>(bound.elements))
      elements.push_back(json_of(each));
    out["samplers"] = elements;
  }
  return out;
}
pipeline::BoundResources bound_of(const Json& json) {
  pipeline::BoundResources out;
  out.place = {json.at("set"), json.at("binding")};
  if (json.contains("buffers")) {
    auto& to = out.elements.emplace<std::vector<pipeline::BufferRange>>();
    for (const Json& each : json["buffers"]) to.push_back({each.at(0), each.at(1)});
  } else if (json.contains("images")) {
    auto& to = out.elements.emplace<std::vector<exec::ImageView>>();
    for (const Json& each : json["images"]) to.push_back(image_of(each));
  } else {
    auto& to = out.elements.emplace<std::vector<exec::Sampler>>();
    for (const Json& each : json.at("samplers")) to.push_back(sampler_of(each));
  }
  return out;
}

Json json_of(const pipeline::DeviceRegion& region) {
  return {region.base, region.stride, region.bytes};
}
pipeline::DeviceRegion region_of(const Json& json) {
  return {json.at(0), json.at(1), json.at(2)};
}

Json json_of(const Capsule::Rays& rays) {
  Json groups = Json::array();
  for (const pipeline::ShaderGroup& each : rays.groups)
    groups.push_back({each.general, each.hit.closest_hit, each.hit.any_hit, each.hit.intersection});
  return {{"groups", groups},
          {"pipeline", rays.pipeline},
          {"table",
           {json_of(rays.table.raygen), json_of(rays.table.miss), json_of(rays.table.hit),
            json_of(rays.table.callable)}},
          {"depths", {rays.max_trace_depth, rays.default_callable_depth, rays.max_callable_depth}},
          {"added_flags", rays.added_flags},
          {"stack", rays.stack_bytes ? Json(*rays.stack_bytes) : Json(nullptr)}};
}
Capsule::Rays rays_of(const Json& json) {
  Capsule::Rays out;
  for (const Json& each : json.at("groups")) {
    pipeline::ShaderGroup& to = out.groups.emplace_back();
    to.general = each.at(0), to.hit = {each.at(1), each.at(2), each.at(3)};
  }
  out.pipeline = json.at("pipeline");
  const Json& table = json.at("table");
  out.table = {region_of(table.at(0)), region_of(table.at(1)), region_of(table.at(2)),
               region_of(table.at(3))};
  const Json& depths = json.at("depths");
  out.max_trace_depth = depths.at(0), out.default_callable_depth = depths.at(1);
  out.max_callable_depth = depths.at(2), out.added_flags = json.at("added_flags");
  if (!json.at("stack").is_null()) out.stack_bytes = json["stack"].get<uint32_t>();
  return out;
}

Json json_of(const pipeline::SavedMemory& memory, Blobs& blobs) {
  Json backings = Json::array(), windows = Json::array(), free = Json::array();
  for (const auto& each : memory.backings) {
    Json contents = Json::array();
    for (const auto& part : each.contents)
      contents.push_back({part.offset, blobs.add(std::span<const char>(part.bytes))});
    backings.push_back({{"physical", each.physical}, {"bytes", each.bytes}, {"contents", contents}});
  }
  for (const auto& each : memory.windows)
    windows.push_back({each.slot, each.backing, each.offset, each.bytes});
  for (const auto& each : memory.free) free.push_back({each.first, each.count});
  return {{"backings", backings}, {"windows", windows}, {"free", free}, {"end", memory.end}};
}
pipeline::SavedMemory memory_of(const Json& json, std::string_view blobs) {
  pipeline::SavedMemory out;
  for (const Json& each : json.at("backings")) {
    auto& to = out.backings.emplace_back();
    to.physical = each.at("physical"), to.bytes = each.at("bytes");
    for (const Json& part : each.at("contents")) {
      const std::vector<char> bytes = blob<char>(blobs, part.at(1));
      to.contents.push_back({part.at(0), std::string(bytes.begin(), bytes.end())});
    }
  }
  for (const Json& each : json.at("windows"))
    out.windows.push_back({each.at(0), each.at(1), each.at(2), each.at(3)});
  for (const Json& each : json.at("free")) out.free.push_back({each.at(0), each.at(1)});
  out.end = json.at("end");
  return out;
}

Json description_of(const Capsule& capsule, Blobs& blobs) {
  Json stages = Json::array(), bindings = Json::array(), structures = Json::array();
  for (const Capsule::Stage& each : capsule.stages) {
    Json constants = Json::array();
    for (const auto& [id, value] : each.constants) constants.push_back({id, value});
    stages.push_back({{"name", each.name},
                      {"entry", each.entry},
                      {"stage", each.stage},
                      {"constants", constants},
                      {"words", blobs.add(std::span(each.words))}});
  }
  for (const auto& each : capsule.bindings) bindings.push_back(json_of(each));
  for (const auto& each : capsule.structures) structures.push_back(json_of(each, blobs));
  return {{"program", capsule.program},
          {"label", capsule.label},
          {"kind", capsule.kind},
          {"shader", capsule.shader},
          {"number", capsule.number},
          {"frame", capsule.frame},
          {"hash", capsule.hash},
          {"config", capsule.config},
          {"cycles", capsule.cycles ? Json(*capsule.cycles) : Json(nullptr)},
          {"structure_format", capsule.structure_format},
          {"size", capsule.size},
          {"base", capsule.base},
          {"stages", stages},
          {"rays", capsule.rays ? json_of(*capsule.rays) : Json(nullptr)},
          {"bindings", bindings},
          {"push_constants", blobs.add(std::span(capsule.push_constants))},
          {"robust", {capsule.robust_buffers, capsule.robust_images}},
          {"micromaps", capsule.has_micromaps},
          {"stack_need", capsule.stack_need},
          {"structures", structures},
          {"memory", json_of(capsule.memory, blobs)}};
}

Capsule capsule_of(const Json& json, std::string_view blobs) {
  Capsule out;
  out.program = json.at("program"), out.label = json.at("label"), out.kind = json.at("kind");
  out.shader = json.at("shader"), out.number = json.at("number"), out.frame = json.at("frame");
  out.hash = json.at("hash"), out.config = json.at("config");
  if (!json.at("cycles").is_null()) out.cycles = json["cycles"].get<uint64_t>();
  out.structure_format = json.at("structure_format"), out.size = json.at("size"), out.base = json.at("base");
  for (const Json& each : json.at("stages")) {
    Capsule::Stage& to = out.stages.emplace_back();
    to.name = each.at("name"), to.entry = each.at("entry"), to.stage = each.at("stage");
    for (const Json& one : each.at("constants")) to.constants[one.at(0)] = one.at(1);
    to.words = blob<uint32_t>(blobs, each.at("words"));
  }
  if (!json.at("rays").is_null()) out.rays = rays_of(json["rays"]);
  for (const Json& each : json.at("bindings")) out.bindings.push_back(bound_of(each));
  out.push_constants = blob<std::byte>(blobs, json.at("push_constants"));
  out.has_micromaps = json.value("micromaps", false);
  out.robust_buffers = json.at("robust").at(0), out.robust_images = json.at("robust").at(1);
  out.stack_need = json.at("stack_need");
  for (const Json& each : json.at("structures")) out.structures.push_back(structure_of(each, blobs));
  out.memory = memory_of(json.at("memory"), blobs);
  return out;
}

void append(std::string& to, uint64_t number) {
  to.append(reinterpret_cast<const char*>(&number), sizeof number);
}

// Takes a number from the front.
uint64_t take(std::string_view& from) {
  uint64_t out = 0;
  if (from.size() < sizeof out) throw std::out_of_range(kDamaged);
  std::memcpy(&out, from.data(), sizeof out);
  from.remove_prefix(sizeof out);
  return out;
}

// This is the default of zstd. A capsule of a trace over a few triangles has 3,553 bytes; it had 24,182.
constexpr int kPackingLevel = 3;

std::string packed(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kPackingLevel);
  GLINT_CHECK(!ZSTD_isError(size), "zstd cannot pack {} bytes: {}", bytes.size(), ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

// Throws std::out_of_range when the bytes are none that `packed` gave for `size` bytes.
std::string unpacked(std::string_view bytes, uint64_t size) {
  if (ZSTD_getFrameContentSize(bytes.data(), bytes.size()) != size) throw std::out_of_range(kDamaged);
  std::string out(size, '\0');
  if (ZSTD_decompress(out.data(), size, bytes.data(), bytes.size()) != size)
    throw std::out_of_range(kDamaged);
  return out;
}

}  // namespace

std::string capsule_bytes(const Capsule& capsule) {
  Blobs blobs;
  // Names come from applications, and may be other than UTF-8.
  const std::string description =
      description_of(capsule, blobs).dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string rest;
  append(rest, description.size());
  rest += description, rest += blobs.bytes();
  std::string body;
  append(body, rest.size());
  body += packed(rest);
  std::string out(kHead);
  append(out, content_hash(body));
  return out + body;
}

Capsule read_capsule(const std::string& path) {
  const std::optional<std::string> text = read_regular_file(path);
  if (!text) throw UserError({path}, "cannot read the file");
  std::string_view body = *text;
  if (!body.starts_with(kMark)) throw UserError({path}, "it is no capsule");
  if (!body.starts_with(kHead))
    throw UserError({path}, "another version of Glint wrote this capsule", "save it again with this one");
  body.remove_prefix(kHead.size());
  try {
    const uint64_t hash = take(body);
    if (hash != content_hash(body)) throw std::out_of_range(kDamaged);
    const uint64_t bytes = take(body);
    const std::string whole = unpacked(body, bytes);
    std::string_view rest = whole;
    const uint64_t size = take(rest);
    if (size > rest.size()) throw std::out_of_range(kDamaged);
    return capsule_of(Json::parse(rest.substr(0, size)), rest.substr(size));
  } catch (const std::out_of_range&) {
    throw UserError({path}, kDamaged, "save it again");
  } catch (const Json::exception& error) {
    throw UserError({path}, fmt::format("the capsule's description is wrong: {}", error.what()),
                    "save it again");
  }
}

}  // namespace glint::setup
