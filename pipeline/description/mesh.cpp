// Loads meshes.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/mesh.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>

#include "scenes/import/obj_loader.h"
#include "scenes/import/scene_file.h"

namespace glint::pipeline {

scenes::Model load_mesh(const std::string& path, const SourceLocation& where, uint32_t threads) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed))
    throw UserError(where, fmt::format("cannot read '{}'", path));
  if (!scenes::names_scene_file(path))
    throw UserError(where, fmt::format("'{}' is not a mesh that is read here", path),
                    "OBJ and glTF files are read");
  if (!path.ends_with(".obj")) {
    scenes::LoadOptions options;
    options.threads = threads;
    return scenes::flattened(scenes::load_gltf(path, options));
  }
  std::vector<scenes::Material> materials;
  return scenes::load_obj(path, materials, {.threads = threads});
}

std::vector<std::byte> mesh_attribute(const DataSource& source) {
  std::vector<std::byte> out;
  const auto append = [&](const auto& value) {
    out.resize(out.size() + sizeof value);
    std::memcpy(out.data() + out.size() - sizeof value, &value, sizeof value);
  };
  const scenes::Model model = load_mesh(source.file, source.where);
  if (source.attribute == "indices")
    for (uint32_t index : model.indices) append(index);
  else
    for (const scenes::Vertex& v : model.vertices)
      if (source.attribute == "normals")
        append(v.normal);
      else if (source.attribute == "coordinates")
        append(v.texture_coordinate);
      else
        append(v.position);
  return out;
}

}  // namespace glint::pipeline
