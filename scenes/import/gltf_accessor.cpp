// Reads the elements of glTF accessors.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/gltf_accessor.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <tiny_gltf.h>

#include "base/diagnostics.h"
#include "scenes/import/gltf_names.h"

namespace glint::scenes {
namespace {

// Adds the components of all elements.
template <class Component>
void add_components(const GltfElements& from, int components, bool normalised, std::vector<float>& out) {
  const float most = std::numeric_limits<Component>::is_integer && normalised
                         ? float(std::numeric_limits<Component>::max())
                         : 1.0f;
  for (size_t i = 0; i < from.count; ++i)
    for (int c = 0; c < components; ++c) {
      Component value;
      std::memcpy(&value, from.first + i * from.stride + size_t(c) * sizeof value, sizeof value);
      out.push_back(normalised ? std::max(float(value) / most, -1.0f) : float(value));
    }
}

}  // namespace

void GltfPlace::fail(const std::string& what) const {
  throw UserError({path}, fmt::format("in {}: {}", part, what));
}

GltfElements elements_of(const GltfPlace& place, const tinygltf::Accessor& accessor, size_t bytes) {
  if (accessor.bufferView < 0 || accessor.sparse.isSparse) place.fail("sparse accessors are not read");
  const tinygltf::BufferView& view =
      named(place.file.bufferViews, accessor.bufferView, "buffer view", place.path);
  const std::vector<unsigned char>& data = named(place.file.buffers, view.buffer, "buffer", place.path).data;
  const int stride = accessor.ByteStride(view);
  if (stride < 1) place.fail("an accessor has a stride that does not fit its type");
  const size_t first = view.byteOffset + accessor.byteOffset;
  const bool fits = first <= data.size() && bytes <= data.size() - first &&
                    accessor.count - 1 <= (data.size() - first - bytes) / size_t(stride);
  if (accessor.count > 0 && !fits) place.fail("an accessor leaves its buffer");
  return {data.data() + first, size_t(stride), accessor.count};
}

std::vector<float> floats_of(const GltfPlace& place, int number, int components, const std::string& name) {
  const tinygltf::Accessor& accessor = named(place.file.accessors, number, "accessor", place.path);
  if (tinygltf::GetNumComponentsInType(uint32_t(accessor.type)) != components)
    place.fail(fmt::format("{} must have {} components", name, components));
  const int bytes = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
  if (bytes < 1) place.fail(fmt::format("{} has components of an unknown type", name));
  const GltfElements from = elements_of(place, accessor, size_t(bytes) * size_t(components));
  std::vector<float> out;
  out.reserve(from.count * size_t(components));
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      add_components<float>(from, components, false, out);
      break;
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      add_components<int8_t>(from, components, accessor.normalized, out);
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      add_components<uint8_t>(from, components, accessor.normalized, out);
      break;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      add_components<int16_t>(from, components, accessor.normalized, out);
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      add_components<uint16_t>(from, components, accessor.normalized, out);
      break;
    default:
      place.fail(fmt::format("{} has components of another type than floats, bytes and shorts", name));
  }
  return out;
}

}  // namespace glint::scenes
