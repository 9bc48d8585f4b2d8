// Hashes the parts of a scene on several threads, and the hashes of the parts in the scene's order.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <vector>

#include "base/host_threads.h"
#include "base/parallel_ranges.h"
#include "scenes/scene.h"

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

// Names a range of one of the three: vertices of a model, indices of a model, or bytes of a texture.
struct Part {
  const Model* vertices = nullptr;
  const Model* indices = nullptr;
  const Texture* texels = nullptr;
  size_t begin = 0, end = 0;
};

// Appends `part` once for each range of `count` things.
void cut(std::vector<Part>& parts, Part part, size_t count) {
  for (size_t begin = 0; begin < count; begin += kPart) {
    part.begin = begin, part.end = std::min(count, begin + kPart);
    parts.push_back(part);
  }
}

void add(ContentHash& hash, const Vertex& v) {
  hash.add(v.position.x, v.position.y);
  hash.add(v.position.z, v.normal.x);
  hash.add(v.normal.y, v.normal.z);
  hash.add(v.texture_coordinate.x, v.texture_coordinate.y);
  hash.add(uint64_t(uint32_t(v.material)));
}

uint32_t texel(const std::vector<uint8_t>& rgba, size_t at) {
  const uint8_t* const b = &rgba[at];
  return uint32_t{b[0]} | uint32_t{b[1]} << 8 | uint32_t{b[2]} << 16 | uint32_t{b[3]} << 24;
}

uint64_t hash_of(const Part& part) {
  ContentHash hash;
  if (part.vertices)
    for (size_t i = part.begin; i < part.end; ++i) add(hash, part.vertices->vertices[i]);
  if (part.indices)
    for (size_t i = part.begin; i < part.end; i += 2)
      hash.add(part.indices->indices[i], i + 1 < part.end ? part.indices->indices[i + 1] : 0);
  if (part.texels)
    for (size_t i = part.begin; i < part.end; i += 8)
      hash.add(texel(part.texels->rgba, i), i + 4 < part.end ? texel(part.texels->rgba, i + 4) : 0);
  return hash.result();
}

// Adds what is not in the parts of a model or texture.
void add(ContentHash& hash, const Model& model) {
  hash.add(uint64_t{model.vertices.size()});
  hash.add(uint64_t{model.indices.size()});
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

uint64_t Scene::hash(uint32_t threads) const {
  ContentHash content;
  std::vector<Part> parts;
  content.add(uint64_t{models.size()});
  for (const Model& model : models) {
    add(content, model);
    cut(parts, {.vertices = &model}, model.vertices.size());
    cut(parts, {.indices = &model}, model.indices.size());
  }
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
  for (const Texture& texture : textures) {
    add(content, texture);
    cut(parts, {.texels = &texture}, texture.rgba.size());
  }
  add(content, camera);
  content.add(uint64_t{alpha_test});

  std::vector<uint64_t> hashes(parts.size());
  parallel_ranges(parts.size(), 4, host_threads(threads), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) hashes[i] = hash_of(parts[i]);
  });
  for (const uint64_t hash : hashes) content.add(hash);
  return content.result();
}

}  // namespace glint::scenes
