// Tests that scenes come back from the store as they were loaded, and that they are loaded anew when a file
// of theirs has changed.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene_store.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>

#include "base/diagnostics.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using glint::test::TemporaryFolder;
using namespace glint::scenes;

namespace {

namespace fs = std::filesystem;

SceneStore store_in(const TemporaryFolder& folder, const std::string& build = "build 1",
                    uint32_t threads = 1) {
  return SceneStore({.folder = folder.path.string(), .build = build, .threads = threads, .least_bytes = 100});
}

Scene load(const std::string& name, SceneStore* store, bool instancing = false) {
  return load_scene(name, {.instancing = instancing, .store = store});
}

// Returns how many scenes the folder holds.
size_t num_kept(const TemporaryFolder& folder) {
  return size_t(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()));
}

void check_same(const Scene& kept, const Scene& made) {
  CHECK(kept.hash() == made.hash());
  CHECK(kept.name == made.name);
  CHECK(kept.form == made.form);
  CHECK(kept.note == made.note);
  CHECK(kept.triangles() == made.triangles());
  CHECK(kept.stored_triangles() == made.stored_triangles());
  CHECK(kept.fraction() == made.fraction());
  CHECK(diagonal(kept) == diagonal(made));
  CHECK(kept.material_names == made.material_names);
  REQUIRE(kept.models.size() == made.models.size());
  for (size_t i = 0; i < made.models.size(); ++i) {
    CHECK(kept.models[i].name == made.models[i].name);
    CHECK(std::ranges::equal(kept.indices_of(i), made.indices_of(i)));
    CHECK(kept.vertices_of(i).size() == made.vertices_of(i).size());
  }
  REQUIRE(kept.textures.size() == made.textures.size());
  for (size_t i = 0; i < made.textures.size(); ++i) {
    CHECK(kept.textures[i].name == made.textures[i].name);
    CHECK(std::ranges::equal(kept.texels_of(i), made.texels_of(i)));
  }
}

// Is a square with a texture, in files that are an hour old.
struct Square {
  TemporaryFolder folder;
  std::string obj = write("square.obj",
                          "mtllib square.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nusemtl red\n"
                          "f 1/1 2/1 3/1\nf 1/1 3/1 4/1\n");
  std::string mtl = write("square.mtl", "newmtl red\nKd 1 0 0\nmap_Kd texel.pfm\n");
  std::string texel = write("texel.pfm", std::string("PF\n1 1\n-1.0\n") + std::string(12, '\0'));

  std::string write(const std::string& name, const std::string& text, int minutes_old = 60) const {
    const std::string path = folder.write(name, text);
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::minutes(minutes_old));
    return path;
  }
};

}  // namespace

TEST_CASE("a built-in scene comes back from the store as it was made") {
  for (const char* name : {"WKND", "SPNZA", "CHSNT", "PARTY"}) {
    CAPTURE(name);
    const TemporaryFolder folder;
    SceneStore store = store_in(folder), other = store_in(folder, "build 1", 3);
    const Scene made = load(name, nullptr), first = load(name, &store), second = load(name, &other);
    CHECK(num_kept(folder) == 1);
    CHECK_FALSE(made.packed);
    REQUIRE(second.packed);
    check_same(first, made);
    check_same(second, made);
    for (size_t i = 0; i < second.textures.size(); ++i)
      CHECK(reinterpret_cast<uintptr_t>(second.texels_of(i).data()) % 64 == 0);
  }
}

TEST_CASE("scenes of other options, of other builds, and damaged ones are made anew") {
  const TemporaryFolder folder;
  SceneStore store = store_in(folder), other = store_in(folder, "build 2");
  const Scene made = load("SHIP", &store);
  load("SHIP", &store, true);
  CHECK(num_kept(folder) == 2);
  load("SHIP", &other);
  CHECK(num_kept(folder) == 3);
  for (const auto& file : fs::directory_iterator(folder.path)) {
    std::string bytes = folder.read(file.path().filename().string());
    bytes[bytes.size() / 2] ^= 1;
    folder.write(file.path().filename().string(), bytes);
  }
  check_same(load("SHIP", &store), made);
  CHECK(num_kept(folder) == 3);
}

TEST_CASE("a moving scene and a small one are not kept") {
  const TemporaryFolder folder;
  SceneStore store = store_in(folder), choosy({.folder = folder.path.string(), .build = "build 1"});
  load_scene("WKND", {.moving = true, .store = &store});
  load("CORNELL", &choosy);
  CHECK(num_kept(folder) == 0);
}

TEST_CASE("a scene of files is loaded anew when one of its files has changed, has come or has gone") {
  const TemporaryFolder folder;
  SceneStore store = store_in(folder);
  const Square square;
  const Scene made = load(square.obj, nullptr);
  check_same(load(square.obj, &store), made);
  check_same(load(square.obj, &store), made);
  CHECK(num_kept(folder) == 1);
  CHECK(load(square.obj, &store).packed);

  square.write("square.mtl", "newmtl red\nKd 0 1 0\nmap_Kd texel.pfm\n");
  CHECK(load(square.obj, &store).materials[0].diffuse == load(square.obj, nullptr).materials[0].diffuse);
  CHECK(load(square.obj, &store).hash() != made.hash());
  square.write("texel.pfm",
               std::string("PF\n1 1\n-1.0\n") + std::string("\0\0\x80\x3f", 4) + std::string(8, '\0'));
  CHECK(load(square.obj, &store).hash() == load(square.obj, nullptr).hash());
  fs::remove(square.texel);
  CHECK_THROWS_AS(load(square.obj, &store), glint::UserError);
  fs::remove(square.mtl);
  CHECK_THROWS_AS(load(square.obj, &store), glint::UserError);
  CHECK(num_kept(folder) == 1);
}

TEST_CASE("a file that may have changed while it was read is not kept") {
  const TemporaryFolder folder;
  SceneStore store = store_in(folder);
  const Square square;
  square.write("square.mtl", "newmtl red\nKd 0 1 0\nmap_Kd texel.pfm\n", 0);
  load(square.obj, &store);
  CHECK(num_kept(folder) == 0);
}
