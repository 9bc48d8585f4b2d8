// Tests that structures come back from the cache as they were built, by geometry, options and builder.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/structure_cache.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <unistd.h>
#include <utility>
#include <vector>

#include "tests/support/catch.h"

namespace glint::pipeline {
namespace {

namespace fs = std::filesystem;

struct Folder {
  fs::path path = fs::temp_directory_path() / ("glint_structures_" + std::to_string(::getpid()));
  Folder() { fs::remove_all(path); }
  ~Folder() { fs::remove_all(path); }
  StructureCache cache(uint64_t least_primitives = 2, const std::string& build = "build 1") const {
    return StructureCache({path.string(), build, 1 << 20, least_primitives});
  }
};

// Makes a strip of triangles over uneven ground.
struct Strip {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  Strip() {
    for (uint32_t i = 0; i < 50; ++i)
      for (const float z : {0.0f, 1.0f}) positions.insert(positions.end(), {float(i), float(i * 7 % 5), z});
    for (uint32_t i = 0; i + 2 < 100; ++i) indices.insert(indices.end(), {i, i + 1, i + 2});
  }
  rt::BottomLevel level() const {
    rt::Geometry geometry;
    geometry.positions = std::as_bytes(std::span(positions));
    geometry.indices = indices;
    return {{geometry}};
  }
};

bool equal(const rt::EncodedStructure& a, const rt::EncodedStructure& b) {
  return a.bytes.size() == b.bytes.size() &&
         std::memcmp(a.bytes.data(), b.bytes.data(), a.bytes.size()) == 0 && a.info.nodes == b.info.nodes &&
         a.info.leaves == b.info.leaves && a.info.depth == b.info.depth &&
         std::memcmp(&a.info.bounds, &b.info.bounds, sizeof a.info.bounds) == 0;
}

bool is_found(const Folder& folder, const rt::BottomLevel& level, const rt::BuildOptions& options = {},
              const std::string& build = "build 1") {
  StructureCache cache = folder.cache(2, build);
  const rt::EncodedStructure out = cache.encode("it", level, options);
  CHECK(equal(out, rt::encode_bottom("it", level, options)));
  return cache.counts().found == 1;
}

TEST_CASE("a structure that was built is found, and is to the byte what would be built") {
  const Folder folder;
  const Strip strip;
  CHECK_FALSE(is_found(folder, strip.level()));
  CHECK(is_found(folder, strip.level()));
}

TEST_CASE("other positions, indices, flags, transforms, formats, layouts and builders find nothing") {
  const Folder folder;
  const Strip strip;
  is_found(folder, strip.level());

  Strip moved = strip, wound = strip;
  moved.positions[7] += 0.25f;
  std::swap(wound.indices[0], wound.indices[1]);
  rt::BottomLevel not_opaque = strip.level(), placed = strip.level(), two = strip.level();
  not_opaque.geometries[0].opaque = false;
  placed.geometries[0].transform[3] = 1;
  two.geometries.push_back(two.geometries[0]);
  rt::BuildOptions wide, single, treelets;
  wide.format.name = "bvh8";
  single.pair_triangles = false;
  treelets.layout.name = "treelet_breadth_first";

  for (const rt::BottomLevel& other : {moved.level(), wound.level(), not_opaque, placed, two})
    CHECK_FALSE(is_found(folder, other));
  for (const rt::BuildOptions& other : {wide, single, treelets})
    CHECK_FALSE(is_found(folder, strip.level(), other));
  CHECK_FALSE(is_found(folder, strip.level(), {}, "build 2"));
  CHECK(is_found(folder, strip.level()));
}

TEST_CASE("other micromaps find nothing") {
  const Folder folder;
  const Strip strip;
  const auto with = [&](const rt::Micromaps& maps) {
    rt::BottomLevel level = strip.level();
    level.geometries[0].micromaps = &maps;
    return is_found(folder, level);
  };
  const rt::Micromaps maps{{false, 1}, std::vector<int32_t>(98, 0), {0x12}};
  rt::Micromaps other_state = maps, other_index = maps, other_format = maps;
  other_state.states[0] = 0x13;
  other_index.index[7] = rt::Micromaps::uniform(rt::MicroState::Opaque);
  other_format.format.two_states = true;
  is_found(folder, strip.level());
  for (const rt::Micromaps& one : {maps, other_state, other_index, other_format}) CHECK_FALSE(with(one));
  CHECK(with(maps));
  CHECK(is_found(folder, strip.level()));
}

TEST_CASE("small structures are built each time and leave no files") {
  const Folder folder;
  const Strip strip;
  StructureCache cache = folder.cache(1000);
  for (int i = 0; i < 2; ++i) cache.encode("it", strip.level(), {});
  CHECK(cache.counts().built == 2);
  CHECK_FALSE(fs::exists(folder.path));
}

TEST_CASE("a damaged file is built anew") {
  const Folder folder;
  const Strip strip;
  is_found(folder, strip.level());
  for (const auto& file : fs::directory_iterator(folder.path)) {
    std::fstream bytes(file.path(), std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(-100, std::ios::end);
    bytes.put('!');
  }
  CHECK_FALSE(is_found(folder, strip.level()));
  CHECK(is_found(folder, strip.level()));
}

}  // namespace
}  // namespace glint::pipeline
