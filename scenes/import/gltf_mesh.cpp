// Reads the triangles of a glTF mesh.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/gltf_mesh.h"

#include <cmath>
#include <fmt/format.h>
#include <tiny_gltf.h>
#include <utility>

#include "base/diagnostics.h"
#include "base/parallel_ranges.h"
#include "scenes/import/gltf_accessor.h"
#include "scenes/import/gltf_names.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

class MeshReader {
 public:
  MeshReader(const tinygltf::Model& file, int mesh, const MeshOptions& options)
      : file_(file),
        options_(options),
        place_{file, options.path, "mesh " + name_of(file.meshes[size_t(mesh)].name, mesh)} {}

  void add(const tinygltf::Primitive& p) {
    if (p.mode != TINYGLTF_MODE_TRIANGLES) fail("only lists of triangles are read");
    const tinygltf::Accessor* positions = floats(p, "POSITION", TINYGLTF_TYPE_VEC3);
    if (!positions) fail("a primitive has no positions");
    const int32_t material = p.material < 0
                                 ? options_.materials.back()
                                 : named(options_.materials, p.material, "material", options_.path);
    Model piece;
    const GltfElements corners = elements(*positions, sizeof(Vec3));
    piece.vertices.resize(corners.count);
    read<Vec3>(corners, piece, [&](Vertex& v, const Vec3& at) {
      if (!std::isfinite(at[0]) || !std::isfinite(at[1]) || !std::isfinite(at[2]))
        fail(fmt::format("a position is ({}, {}, {})", at[0], at[1], at[2]));
      v.position = at, v.material = material;
    });
    const tinygltf::Accessor* normals = floats(p, "NORMAL", TINYGLTF_TYPE_VEC3);
    if (normals)
      read<Vec3>(elements(*normals, sizeof(Vec3)), piece, [](Vertex& v, const Vec3& at) { v.normal = at; });
    if (const auto* coordinates = floats(p, "TEXCOORD_0", TINYGLTF_TYPE_VEC2))
      read<Vec2>(elements(*coordinates, sizeof(Vec2)), piece,
                 [](Vertex& v, const Vec2& at) { v.texture_coordinate = at; });
    piece.indices = indices(p, piece.vertices.size());
    origins.push_back({uint32_t(model.vertices.size()), uint32_t(piece.vertices.size()), {}});
    if (!normals) origins.back().corners = piece.indices;
    append(normals ? std::move(piece) : with_flat_normals(piece));
  }
  Model model;
  std::vector<PrimitiveOrigin> origins;

 private:
  [[noreturn]] void fail(const std::string& what) const { place_.fail(what); }
  GltfElements elements(const tinygltf::Accessor& accessor, size_t bytes) const {
    return elements_of(place_, accessor, bytes);
  }

  static constexpr size_t kRange = 65536;  // elements that a thread reads at a time

  template <class Value, class Put>
  void read(const GltfElements& from, Model& piece, const Put& put) const {
    if (from.count != piece.vertices.size()) fail("the attributes of a primitive have different counts");
    parallel_ranges(from.count, kRange, options_.threads, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) put(piece.vertices[i], from.at<Value>(i));
    });
  }

  const tinygltf::Accessor* floats(const tinygltf::Primitive& p, const char* name, int type) const {
    const auto found = p.attributes.find(name);
    if (found == p.attributes.end()) return nullptr;
    const tinygltf::Accessor& accessor = named(file_.accessors, found->second, "accessor", options_.path);
    if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT || accessor.type != type)
      fail(fmt::format("{} must be float", name));
    return &accessor;
  }

  std::vector<uint32_t> indices(const tinygltf::Primitive& p, size_t count) const {
    std::vector<uint32_t> out;
    if (p.indices < 0) {
      for (size_t i = 0; i < count / 3 * 3; ++i) out.push_back(uint32_t(i));
      return out;
    }
    const tinygltf::Accessor& accessor = named(file_.accessors, p.indices, "accessor", options_.path);
    const int bytes = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
    if (bytes != 1 && bytes != 2 && bytes != 4) fail("indices have 1, 2 or 4 bytes");
    const GltfElements from = elements(accessor, size_t(bytes));
    out.resize(from.count);
    parallel_ranges(from.count, kRange, options_.threads, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        out[i] = from.at<uint32_t>(i, size_t(bytes));
        if (out[i] >= count) fail(fmt::format("an index is {} and there are {} vertices", out[i], count));
      }
    });
    out.resize(out.size() / 3 * 3);
    return out;
  }

  // Gives every triangle corners of its own, so that smoothing changes nothing.
  static Model with_flat_normals(const Model& piece) {
    Model faces;
    for (const uint32_t index : piece.indices) {
      faces.indices.push_back(uint32_t(faces.vertices.size()));
      faces.vertices.push_back(piece.vertices[index]);
    }
    compute_smooth_normals(faces);
    return faces;
  }

  void append(Model piece) {
    const auto first = uint32_t(model.vertices.size());
    if (first == 0) {
      model = std::move(piece);
      return;
    }
    model.vertices.insert(model.vertices.end(), piece.vertices.begin(), piece.vertices.end());
    for (const uint32_t index : piece.indices) model.indices.push_back(first + index);
  }

  const tinygltf::Model& file_;
  const MeshOptions& options_;
  const GltfPlace place_;
};

}  // namespace

Model read_mesh(const tinygltf::Model& file, int mesh, const MeshOptions& options,
                std::vector<PrimitiveOrigin>* origins) {
  const tinygltf::Mesh& source = named(file.meshes, mesh, "mesh", options.path);
  MeshReader reader(file, mesh, options);
  for (const tinygltf::Primitive& primitive : source.primitives) reader.add(primitive);
  reader.model.name = source.name;
  if (origins) *origins = std::move(reader.origins);
  return std::move(reader.model);
}

}  // namespace glint::scenes
