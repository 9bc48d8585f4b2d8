// Builds bottom levels from a script's vertices and boxes, and top levels from its instances.
// SPDX-License-Identifier: Apache-2.0
#include "amber/structure_memory.h"

#include <span>
#include <vector>

namespace glint::amber {

const rt::StructureInfo& StructureMemory::bottom_level(const std::string& name) {
  if (const auto known = bottom_levels_.find(name); known != bottom_levels_.end()) return known->second;
  rt::BottomLevel level;
  for (const BottomLevel::Geometry& g : script_.bottom_levels.at(name).geometries) {
    rt::Geometry geometry;
    geometry.positions = std::as_bytes(std::span(g.vertices)), geometry.aabbs = g.boxes;
    geometry.opaque = g.opaque, geometry.no_duplicate_any_hit = g.no_duplicate_any_hit;
    level.geometries.push_back(geometry);
  }
  return bottom_levels_.emplace(name, rt::build_bottom(memory_, "bottom level " + name, level, options_))
      .first->second;
}

const rt::StructureInfo& StructureMemory::top_level(const std::string& name) {
  if (const auto known = top_levels_.find(name); known != top_levels_.end()) return known->second;
  std::vector<rt::StructureInfo> bottoms;
  std::map<std::string, uint32_t> index_of;
  std::vector<rt::Instance> instances;
  for (const auto& [bottom, description] : script_.top_levels.at(name).instances) {
    const auto [known, is_first] = index_of.try_emplace(bottom, uint32_t(bottoms.size()));
    if (is_first) bottoms.push_back(bottom_level(bottom));
    instances.push_back(description);
    instances.back().bottom = known->second;
  }
  return top_levels_.emplace(name, rt::build_top(memory_, "top level " + name, instances, bottoms, options_))
      .first->second;
}

}  // namespace glint::amber
