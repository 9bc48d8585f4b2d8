// Walking the nodes of a glTF scene.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/gltf.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

namespace glint::pipeline {
namespace {

using Matrix = std::array<double, 16>;  // columns one after the other, as glTF has them

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (size_t c = 0; c < 4; ++c)
    for (size_t r = 0; r < 4; ++r)
      for (size_t k = 0; k < 4; ++k) out[c * 4 + r] += a[k * 4 + r] * b[c * 4 + k];
  return out;
}

// glTF 2.0, 3.5.3: a matrix, or translation * rotation (a quaternion x y z w) * scale.
Matrix local_matrix(const tinygltf::Node& node) {
  Matrix out{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  if (node.matrix.size() == 16) {
    std::copy(node.matrix.begin(), node.matrix.end(), out.begin());
    return out;
  }
  if (node.rotation.size() == 4) {
    const double x = node.rotation[0], y = node.rotation[1], z = node.rotation[2], w = node.rotation[3];
    out = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0, 2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0,
           2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0, 0, 0, 0, 1};
  }
  for (size_t c = 0; c < 3 && node.scale.size() == 3; ++c)
    for (size_t r = 0; r < 3; ++r) out[c * 4 + r] *= node.scale[c];
  for (size_t r = 0; r < 3 && node.translation.size() == 3; ++r) out[12 + r] = node.translation[r];
  return out;
}

class Walk {
 public:
  Walk(const tinygltf::Model& file, std::string path, SourceLocation where) : file_(file), path_(std::move(path)), where_(std::move(where)) {}
  scenes::Model model;

  void node(int index, const Matrix& above, int depth) {
    if (depth > 64) fail("its nodes form a loop");
    const tinygltf::Node& node = file_.nodes.at(size_t(index));
    const Matrix matrix = product(above, local_matrix(node));
    if (node.mesh >= 0)
      for (const tinygltf::Primitive& p : file_.meshes.at(size_t(node.mesh)).primitives) primitive(p, matrix);
    for (int child : node.children) this->node(child, matrix, depth + 1);
  }
  [[noreturn]] void fail(const std::string& what) const { throw UserError(where_, fmt::format("cannot use '{}': {}", path_, what)); }

 private:
  // Calls put(element, bytes) for each element; they must be `components` of `type`, and lie inside their buffer.
  template <class Put>
  size_t each(const tinygltf::Accessor& accessor, size_t bytes, const Put& put) const {
    if (accessor.bufferView < 0 || accessor.sparse.isSparse) fail("sparse accessors are not read");
    const tinygltf::BufferView& view = file_.bufferViews.at(size_t(accessor.bufferView));
    const std::vector<unsigned char>& data = file_.buffers.at(size_t(view.buffer)).data;
    const size_t stride = size_t(accessor.ByteStride(view)), first = view.byteOffset + accessor.byteOffset;
    if (accessor.count && first + (accessor.count - 1) * stride + bytes > data.size()) fail("an accessor leaves its buffer");
    for (size_t i = 0; i < accessor.count; ++i) put(i, data.data() + first + i * stride);
    return accessor.count;
  }

  const tinygltf::Accessor* floats(const tinygltf::Primitive& p, const char* name, int type) const {
    const auto found = p.attributes.find(name);
    if (found == p.attributes.end()) return nullptr;
    const tinygltf::Accessor& accessor = file_.accessors.at(size_t(found->second));
    if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT || accessor.type != type) fail(fmt::format("{} must be float", name));
    return &accessor;
  }

  void primitive(const tinygltf::Primitive& p, const Matrix& m) {
    if (p.mode != TINYGLTF_MODE_TRIANGLES) fail("only lists of triangles are read");
    const size_t base = model.vertices.size();
    const tinygltf::Accessor* positions = floats(p, "POSITION", TINYGLTF_TYPE_VEC3);
    if (!positions) fail("a primitive has no positions");
    const size_t count = each(*positions, 12, [&](size_t, const unsigned char* at) {
      float v[3];
      std::memcpy(v, at, sizeof v);
      scenes::Vertex vertex;
      for (size_t r = 0; r < 3; ++r) vertex.position[r] = float(m[r] * double(v[0]) + m[4 + r] * double(v[1]) + m[8 + r] * double(v[2]) + m[12 + r]);
      model.vertices.push_back(vertex);
    });
    if (const auto* normals = floats(p, "NORMAL", TINYGLTF_TYPE_VEC3); normals && normals->count == count)
      each(*normals, 12, [&](size_t i, const unsigned char* at) {  // Model: rotated as directions are; wrong under uneven scaling
        float v[3];
        std::memcpy(v, at, sizeof v);
        for (size_t r = 0; r < 3; ++r) model.vertices[base + i].normal[r] = float(m[r] * double(v[0]) + m[4 + r] * double(v[1]) + m[8 + r] * double(v[2]));
      });
    if (const auto* at2 = floats(p, "TEXCOORD_0", TINYGLTF_TYPE_VEC2); at2 && at2->count == count)
      each(*at2, 8, [&](size_t i, const unsigned char* at) { std::memcpy(model.vertices[base + i].texture_coordinate.data(), at, 8); });
    indices(p, base, count);
  }

  void indices(const tinygltf::Primitive& p, size_t base, size_t count) {
    const auto add = [&](uint32_t index) {
      if (index >= count) fail("an index is out of range");
      model.indices.push_back(uint32_t(base) + index);
    };
    if (p.indices < 0) {
      for (size_t i = 0; i < count / 3 * 3; ++i) add(uint32_t(i));
      return;
    }
    const tinygltf::Accessor& accessor = file_.accessors.at(size_t(p.indices));
    const int bytes = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
    if (bytes != 1 && bytes != 2 && bytes != 4) fail("indices have 1, 2 or 4 bytes");
    each(accessor, size_t(bytes), [&](size_t, const unsigned char* at) {
      uint32_t index = 0;
      std::memcpy(&index, at, size_t(bytes));
      add(index);
    });
  }

  const tinygltf::Model& file_;
  const std::string path_;
  const SourceLocation where_;
};

}  // namespace

scenes::Model load_gltf(const std::string& path, const SourceLocation& where) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) { return true; }, nullptr);
  tinygltf::Model file;
  std::string error, warning;
  const bool good = path.ends_with(".glb") ? loader.LoadBinaryFromFile(&file, &error, &warning, path) : loader.LoadASCIIFromFile(&file, &error, &warning, path);
  if (!good) throw UserError(where, fmt::format("cannot read '{}': {}", path, error));
  Walk walk(file, path, where);
  try {
    if (file.scenes.empty()) walk.fail("it has no scene");
    for (int node : file.scenes.at(size_t(std::max(0, file.defaultScene))).nodes) walk.node(node, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 0);
  } catch (const std::out_of_range&) {
    walk.fail("it names something that is not there");
  }
  return std::move(walk.model);
}

}  // namespace glint::pipeline
