// Hashes the parts of a scene on several threads, and the hashes of the parts in the scene's order.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene_hash.h"

#include <algorithm>
#include <bit>
#include <span>
#include <vector>

#include "base/host_threads.h"
#include "base/parallel_ranges.h"

namespace glint::scenes {
namespace {

// Hashes contents with FNV-1a, widened to 64-bit words and finished as in MurmurHash3. It takes values, never
// the bytes of structs, so neither padding nor byte order changes the hash.
class ContentHash {
 public:
  void add(uint64_t word) { state_ = (state_ ^ word) * 0x100000001b3 ^ state_ >> 29; }
  void add(uint32_t low, uint32_t high) { add(uint64_t{high} << 32 | low); }
  void add(float value) { add(uint64_t{std::bit_cast<uint32_t>(value)}); }
  void add(float low, float high) { add(std::bit_cast<uint32_t>(low), std::bit_cast<uint32_t>(high)); }
  // Takes a vector, or a matrix in the order of its floats.
  template <class Values>
  requires(Values::length() > 0) void add(const Values& values) {
    for (size_t i = 0; i < Values::length(); ++i) add(values[i]);
  }
  uint64_t result() const {
    uint64_t x = state_;
    x = (x ^ x >> 33) * 0xff51afd7ed558ccd;
    x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53;
    return x ^ x >> 33;
  }

 private:
  uint64_t state_ = 0xcbf29ce484222325;
};

constexpr size_t kPart = 1 << 16;  // vertices, indices or bytes of texels that one thread hashes at a time

// Is a range of one of the three: vertices of a model, indices of a model, or texels of a texture.
struct Part {
  std::span<const Vertex> vertices = {};
  std::span<const uint32_t> indices = {};
  std::span<const uint8_t> rgba = {};
};

// Appends a part for each range of `values`, which `part` makes of the range.
template <class Value, class MakePart>
void cut(std::vector<Part>& parts, std::span<const Value> values, const MakePart& part) {
  for (size_t begin = 0; begin < values.size(); begin += kPart)
    parts.push_back(part(values.subspan(begin, std::min(kPart, values.size() - begin))));
}

void add(ContentHash& hash, const Vertex& v) {
  hash.add(v.position.x, v.position.y);
  hash.add(v.position.z, v.normal.x);
  hash.add(v.normal.y, v.normal.z);
  hash.add(v.texture_coordinate.x, v.texture_coordinate.y);
  hash.add(uint64_t(uint32_t(v.material)));
}

uint32_t texel(std::span<const uint8_t> rgba, size_t at) {
  const uint8_t* const b = &rgba[at];
  return uint32_t{b[0]} | uint32_t{b[1]} << 8 | uint32_t{b[2]} << 16 | uint32_t{b[3]} << 24;
}

uint64_t hash_of(const Part& part) {
  ContentHash hash;
  for (const Vertex& vertex : part.vertices) add(hash, vertex);
  for (size_t i = 0; i < part.indices.size(); i += 2)
    hash.add(part.indices[i], i + 1 < part.indices.size() ? part.indices[i + 1] : 0);
  for (size_t i = 0; i < part.rgba.size(); i += 8)
    hash.add(texel(part.rgba, i), i + 4 < part.rgba.size() ? texel(part.rgba, i + 4) : 0);
  return hash.result();
}

// Adds what is not in the parts of a model or texture.
void add_model(ContentHash& hash, const Scene& scene, size_t number) {
  const Model& model = scene.models[number];
  hash.add(uint64_t{scene.vertices_of(number).size()});
  hash.add(uint64_t{scene.indices_of(number).size()});
  hash.add(model.center);
  hash.add(model.radius);
}

void add(ContentHash& hash, const Texture& texture) {
  hash.add(texture.width, texture.height);
  hash.add(uint64_t{texture.srgb} << 1 | uint64_t{texture.repeat});
}

void add(ContentHash& hash, const Camera& c) {
  for (const Vec3& v : {c.eye, c.target, c.up, c.light_position}) hash.add(v);
  for (const float value : {c.field_of_view, c.aperture, c.focus_distance, c.light_radius}) hash.add(value);
  hash.add(uint64_t{c.has_sky});
}

}  // namespace

std::vector<uint64_t> content_hashes(const Scene& scene, uint32_t threads) {
  if (scene.packed) return scene.packed->hashes;
  std::vector<Part> parts;
  for (size_t i = 0; i < scene.models.size(); ++i) {
    cut(parts, scene.vertices_of(i), [](std::span<const Vertex> range) { return Part{.vertices = range}; });
    cut(parts, scene.indices_of(i), [](std::span<const uint32_t> range) { return Part{.indices = range}; });
  }
  for (size_t i = 0; i < scene.textures.size(); ++i)
    cut(parts, scene.texels_of(i), [](std::span<const uint8_t> range) { return Part{.rgba = range}; });
  std::vector<uint64_t> hashes(parts.size());
  parallel_ranges(parts.size(), 4, host_threads(threads), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) hashes[i] = hash_of(parts[i]);
  });
  return hashes;
}

uint64_t Scene::hash(uint32_t threads) const {
  ContentHash content;
  content.add(uint64_t{models.size()});
  for (size_t i = 0; i < models.size(); ++i) add_model(content, *this, i);
  for (const Instance& instance : instances) {
    content.add(uint64_t{instance.model});
    content.add(instance.to_world);
  }
  content.add(uint64_t{materials.size()});
  for (const Material& m : materials) {
    content.add(m.diffuse);
    content.add(uint64_t(uint32_t(m.texture)));
    content.add(m.fuzziness);
    content.add(m.refraction_index);
    content.add(uint64_t(m.model));
  }
  content.add(uint64_t{textures.size()});
  for (const Texture& texture : textures) add(content, texture);
  add(content, camera);
  content.add(uint64_t{alpha_test});
  for (const uint64_t hash : content_hashes(*this, threads)) content.add(hash);
  return content.result();
}

}  // namespace glint::scenes
