// Describes structures of a capsule in JSON: geometries, opacity micromaps and instances.
// SPDX-License-Identifier: Apache-2.0
#include "setup/capsule_structures.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace glint::setup {
namespace {

Json json_of(const rt::Micromaps& micromaps, Blobs& blobs) {
  return {{"level", micromaps.format.level},
          {"two_states", micromaps.format.two_states},
          {"index", blobs.add(std::span(micromaps.index))},
          {"states", blobs.add(std::span(micromaps.states))}};
}
// Reads the maps of that many triangles. What names no map counts as damaged.
rt::Micromaps micromaps_of(const Json& json, std::string_view blobs, size_t triangles) {
  rt::Micromaps out{{json.at("two_states"), json.at("level")},
                    blob<int32_t>(blobs, json.at("index")),
                    blob<uint8_t>(blobs, json.at("states")),
                    true};
  const bool has_level = out.format.level <= rt::MicromapFormat::kMostLevels;
  const size_t maps = has_level ? out.states.size() / out.format.bytes() : 0;
  const bool is_whole = std::all_of(out.index.begin(), out.index.end(), [&](int32_t index) {
    return index >= rt::Micromaps::uniform(rt::MicroState::UnknownOpaque) && index < int64_t(maps);
  });
  if (!has_level || !is_whole || out.index.size() < triangles) throw std::out_of_range(kDamaged);
  return out;
}

}  // namespace

Json json_of(const pipeline::PlacedStructure& structure, Blobs& blobs) {
  Json out = {{"name", structure.name}, {"address", structure.address}, {"room", structure.room}};
  if (!structure.inputs) return out;
  const pipeline::StructureInputs& inputs = *structure.inputs;
  if (inputs.is_top) {
    out["instances"] = blobs.add(std::span(inputs.instances));
    return out;
  }
  Json geometries = Json::array();
  for (const auto& each : inputs.geometries) {
    Json& to = geometries.emplace_back(Json{{"positions", blobs.add(std::span(each.positions))},
                                            {"indices", blobs.add(std::span(each.indices))},
                                            {"boxes", blobs.add(std::span(each.boxes))},
                                            {"transform", blobs.add(std::span<const float>(each.transform))},
                                            {"flags", {each.opaque, each.no_duplicate_any_hit}}});
    if (each.micromaps) to["micromaps"] = json_of(*each.micromaps, blobs);
  }
  out["geometries"] = geometries;
  return out;
}
pipeline::PlacedStructure structure_of(const Json& json, std::string_view blobs) {
  pipeline::PlacedStructure out{json.at("name"), json.at("address"), json.at("room"), nullptr};
  auto inputs = std::make_shared<pipeline::StructureInputs>();
  inputs->is_top = json.contains("instances");
  if (inputs->is_top) inputs->instances = blob<rt::DeviceInstance>(blobs, json["instances"]);
  if (json.contains("geometries"))
    for (const Json& each : json["geometries"]) {
      const std::vector<float> transform = blob<float>(blobs, each.at("transform"));
      auto& to = inputs->geometries.emplace_back();
      to.positions = blob<float>(blobs, each.at("positions"));
      to.indices = blob<uint32_t>(blobs, each.at("indices"));
      to.boxes = blob<rt::Bounds>(blobs, each.at("boxes"));
      if (transform.size() != to.transform.size()) throw std::out_of_range(kDamaged);
      std::copy(transform.begin(), transform.end(), to.transform.begin());
      to.opaque = each.at("flags").at(0), to.no_duplicate_any_hit = each.at("flags").at(1);
      const size_t corners = to.indices.empty() ? to.positions.size() / 3 : to.indices.size();
      if (each.contains("micromaps")) to.micromaps = micromaps_of(each["micromaps"], blobs, corners / 3);
    }
  if (inputs->is_top || json.contains("geometries")) out.inputs = std::move(inputs);
  return out;
}

}  // namespace glint::setup
