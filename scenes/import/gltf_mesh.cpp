// Reads the triangles of a glTF mesh.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/gltf_mesh.h"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <tiny_gltf.h>
#include <utility>

#include "base/diagnostics.h"
#include "scenes/import/gltf_names.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

class MeshReader {
 public:
  MeshReader(const tinygltf::Model& file, int mesh, const std::vector<int32_t>& materials,
             const std::string& path)
      : file_(file),
        name_(name_of(file.meshes[size_t(mesh)].name, mesh)),
        materials_(materials),
        path_(path) {}

  void add(const tinygltf::Primitive& p) {
    if (p.mode != TINYGLTF_MODE_TRIANGLES) fail("only lists of triangles are read");
    const tinygltf::Accessor* positions = floats(p, "POSITION", TINYGLTF_TYPE_VEC3);
    if (!positions) fail("a primitive has no positions");
    const int32_t material =
        p.material < 0 ? materials_.back() : named(materials_, p.material, "material", path_);
    std::vector<Vertex> vertices(positions->count);
    read<Vec3>(*positions, vertices, [&](Vertex& v, const Vec3& at) {
      if (!std::isfinite(at[0]) || !std::isfinite(at[1]) || !std::isfinite(at[2]))
        fail(fmt::format("a position is ({}, {}, {})", at[0], at[1], at[2]));
      v.position = at, v.material = material;
    });
    const tinygltf::Accessor* normals = floats(p, "NORMAL", TINYGLTF_TYPE_VEC3);
    if (normals) read<Vec3>(*normals, vertices, [](Vertex& v, const Vec3& at) { v.normal = at; });
    if (const auto* coordinates = floats(p, "TEXCOORD_0", TINYGLTF_TYPE_VEC2))
      read<Vec2>(*coordinates, vertices, [](Vertex& v, const Vec2& at) { v.texture_coordinate = at; });
    append(vertices, indices(p, vertices.size()), normals == nullptr);
  }
  Model model;

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw UserError({path_}, fmt::format("in mesh {}: {}", name_, what));
  }

  // Calls put(element, bytes) for each of an accessor's elements of `bytes` bytes.
  template <class Put>
  void each(const tinygltf::Accessor& accessor, size_t bytes, const Put& put) const {
    if (accessor.bufferView < 0 || accessor.sparse.isSparse) fail("sparse accessors are not read");
    const tinygltf::BufferView& view = named(file_.bufferViews, accessor.bufferView, "buffer view", path_);
    const std::vector<unsigned char>& data = named(file_.buffers, view.buffer, "buffer", path_).data;
    const int stride = accessor.ByteStride(view);
    if (stride < 1) fail("an accessor has a stride that does not fit its type");
    const size_t first = view.byteOffset + accessor.byteOffset;
    const bool fits = first <= data.size() && bytes <= data.size() - first &&
                      accessor.count - 1 <= (data.size() - first - bytes) / size_t(stride);
    if (accessor.count > 0 && !fits) fail("an accessor leaves its buffer");
    for (size_t i = 0; i < accessor.count; ++i) put(i, data.data() + first + i * size_t(stride));
  }

  template <class Value, class Put>
  void read(const tinygltf::Accessor& accessor, std::vector<Vertex>& vertices, const Put& put) const {
    if (accessor.count != vertices.size()) fail("the attributes of a primitive have different counts");
    each(accessor, sizeof(Value), [&](size_t i, const unsigned char* bytes) {
      Value value;
      std::memcpy(&value, bytes, sizeof value);
      put(vertices[i], value);
    });
  }

  const tinygltf::Accessor* floats(const tinygltf::Primitive& p, const char* name, int type) const {
    const auto found = p.attributes.find(name);
    if (found == p.attributes.end()) return nullptr;
    const tinygltf::Accessor& accessor = named(file_.accessors, found->second, "accessor", path_);
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
    const tinygltf::Accessor& accessor = named(file_.accessors, p.indices, "accessor", path_);
    const int bytes = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
    if (bytes != 1 && bytes != 2 && bytes != 4) fail("indices have 1, 2 or 4 bytes");
    each(accessor, size_t(bytes), [&](size_t, const unsigned char* at) {
      uint32_t index = 0;
      std::memcpy(&index, at, size_t(bytes));
      if (index >= count) fail(fmt::format("an index is {} and there are {} vertices", index, count));
      out.push_back(index);
    });
    out.resize(out.size() / 3 * 3);
    return out;
  }

  // Appends triangles. With `flat`, every triangle gets corners of its own, so that smoothing changes
  // nothing.
  void append(const std::vector<Vertex>& vertices, const std::vector<uint32_t>& indices, bool flat) {
    const auto first = uint32_t(model.vertices.size());
    if (!flat) {
      model.vertices.insert(model.vertices.end(), vertices.begin(), vertices.end());
      for (const uint32_t index : indices) model.indices.push_back(first + index);
      return;
    }
    Model faces;
    for (const uint32_t index : indices) {
      faces.indices.push_back(uint32_t(faces.vertices.size()));
      faces.vertices.push_back(vertices[index]);
    }
    compute_smooth_normals(faces);
    model.vertices.insert(model.vertices.end(), faces.vertices.begin(), faces.vertices.end());
    for (const uint32_t index : faces.indices) model.indices.push_back(first + index);
  }

  const tinygltf::Model& file_;
  const std::string name_;  // of the mesh, for messages
  const std::vector<int32_t>& materials_;
  const std::string& path_;
};

}  // namespace

Model read_mesh(const tinygltf::Model& file, int mesh, const std::vector<int32_t>& materials,
                const std::string& path) {
  const tinygltf::Mesh& source = named(file.meshes, mesh, "mesh", path);
  MeshReader reader(file, mesh, materials, path);
  for (const tinygltf::Primitive& primitive : source.primitives) reader.add(primitive);
  reader.model.name = source.name;
  return std::move(reader.model);
}

}  // namespace glint::scenes
