// Turns scenes into values of a store, and values into scenes whose geometry stays in the pages of its files.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene_store.h"

#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/byte_stream.h"
#include "scenes/scene_hash.h"

namespace glint::scenes {

// A model's vertices and indices lie elsewhere.
template <class Visit>
void for_each_field(Model& model, const Visit& visit) {
  visit(model.name);
  visit(model.center);
  visit(model.radius);
}
template <class Visit>
void for_each_field(Texture& texture, const Visit& visit) {
  visit(texture.name);
  visit(texture.width);
  visit(texture.height);
  visit(texture.srgb);
  visit(texture.repeat);
}
template <class Visit>
void for_each_field(PackedContents& packed, const Visit& visit) {
  visit(packed.models);
  visit(packed.hashes);
}
template <class Visit>
void for_each_field(Scene& scene, const Visit& visit) {
  visit(scene.name);
  visit(scene.form);
  visit(scene.note);
  visit(scene.models);
  visit(scene.instances);
  visit(scene.materials);
  visit(scene.material_names);
  visit(scene.textures);
  visit(scene.camera);
  visit(scene.alpha_test);
  visit(scene.original_triangles);
}

namespace {

constexpr uint64_t kAlignment = 64;  // bytes; PackedContents::memory

uint64_t bytes_of(const Scene& scene) {
  uint64_t bytes = 0;
  for (const Model& model : scene.models)
    bytes += model.vertices.size() * sizeof(Vertex) + model.indices.size() * sizeof(uint32_t);
  for (const Texture& texture : scene.textures) bytes += texture.rgba.size();
  return bytes;
}

// Lists what the block of a scene consists of.
class Pieces {
 public:
  template <class Value>
  void add(const std::vector<Value>& values) {
    pieces_.emplace_back(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
    bytes_ += pieces_.back().size();
  }
  void align() {
    static constexpr char kZeros[kAlignment] = {};
    pieces_.emplace_back(kZeros, (kAlignment - bytes_ % kAlignment) % kAlignment);
    bytes_ += pieces_.back().size();
  }
  const std::vector<std::string_view>& list() const { return pieces_; }

 private:
  std::vector<std::string_view> pieces_;
  uint64_t bytes_ = 0;
};

Pieces pieces_of(const Scene& scene) {
  Pieces out;
  for (const Model& model : scene.models) out.add(model.vertices);
  out.align();
  for (const Model& model : scene.models) out.add(model.indices);
  out.align();
  for (const Texture& texture : scene.textures) {
    out.add(texture.rgba);
    out.align();
  }
  return out;
}

// Takes values one after another out of the block of a scene.
class Block {
 public:
  Block(char* data, uint64_t bytes) : data_(data), left_(bytes) {}
  template <class Value>
  std::span<Value> take(uint64_t count) {
    const uint64_t bytes = (count * sizeof(Value) + kAlignment - 1) / kAlignment * kAlignment;
    is_good_ &= count <= left_ && bytes <= left_;
    if (!is_good_) return {};
    const std::span<Value> out(reinterpret_cast<Value*>(data_), size_t(count));
    data_ += bytes, left_ -= bytes;
    return out;
  }
  bool is_used_up() const { return is_good_ && left_ == 0; }

 private:
  char* data_;
  uint64_t left_;
  bool is_good_ = true;
};

PackedContents outline_of(const Scene& scene, uint32_t threads) {
  PackedContents out;
  PackedContents::Range range;
  for (const Model& model : scene.models) {
    range.vertices = model.vertices.size(), range.indices = model.indices.size();
    out.models.push_back(range);
    range.first_vertex += range.vertices, range.first_index += range.indices;
  }
  out.hashes = content_hashes(scene, threads);
  return out;
}

}  // namespace

SceneStore::SceneStore(const Options& options)
    : least_bytes_(options.least_bytes),
      threads_(options.threads),
      files_({options.folder, ".scene", options.build, options.max_bytes, options.threads}) {
}

Scene SceneStore::find_or_load(const std::string& key, const std::function<Scene(LookupLog*)>& load) {
  if (std::optional<Scene> found = find(key)) return std::move(*found);
  LookupLog log;
  Scene scene = load(&log);
  if (bytes_of(scene) < least_bytes_) return scene;
  const std::optional<std::vector<Lookup>> lookups = log.lookups(threads_);
  if (!lookups) return scene;
  store(key, *lookups, scene);
  // The contents are in memory twice until the scene that was loaded goes.
  std::optional<Scene> kept = find(key);
  return kept ? std::move(*kept) : scene;
}

std::optional<Scene> SceneStore::find(const std::string& key) {
  std::optional<FileStore::Large> value = files_.find_large(key);
  if (!value) return std::nullopt;
  ByteReader in(value->head);
  const auto lookups = in.take<std::vector<Lookup>>();
  Scene scene;
  in.get(scene);
  PackedContents packed;
  in.get(packed);
  if (!in.is_good() || packed.models.empty() || !are_unchanged(lookups, threads_)) return std::nullopt;
  const PackedContents::Range& last = packed.models.back();
  Block block(value->rest, value->bytes);
  packed.vertices = block.take<Vertex>(last.first_vertex + last.vertices);
  packed.indices = block.take<uint32_t>(last.first_index + last.indices);
  for (const Texture& texture : scene.textures)
    packed.texels.push_back(block.take<uint8_t>(uint64_t{4} * texture.width * texture.height));
  if (!block.is_used_up()) return std::nullopt;
  packed.memory = std::move(value->pages);
  scene.packed = std::make_shared<PackedContents>(std::move(packed));
  return scene;
}

void SceneStore::store(const std::string& key, const std::vector<Lookup>& lookups, const Scene& scene) {
  ByteWriter head;
  head.put(lookups);
  head.put(scene);
  head.put(outline_of(scene, threads_));
  files_.store(key, head.take(), pieces_of(scene).list());
}

}  // namespace glint::scenes
