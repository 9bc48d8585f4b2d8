// Tests the OBJ loader: vertices, materials, mistakes, and the same model at any number of threads.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <random>

#include "base/diagnostics.h"
#include "scenes/import/obj_loader.h"
#include "scenes/mesh.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using glint::test::TemporaryFolder;
using namespace glint::scenes;

namespace {

struct Loaded {
  Model model;
  std::vector<Material> materials;
};
Loaded load(const std::string& file, uint32_t threads = 1, size_t chunk_bytes = 4 << 20) {
  Loaded out;
  out.model = load_obj(file, out.materials, {.threads = threads, .chunk_bytes = chunk_bytes});
  return out;
}

std::string error_of(const std::string& file, size_t chunk_bytes) {
  try {
    load(file, 3, chunk_bytes);
  } catch (const glint::UserError& error) {
    return error.what();
  }
  return "no error";
}

bool same(const Model& a, const Model& b) {
  const auto equal = [](const Vertex& x, const Vertex& y) {
    return x.position == y.position && x.normal == y.normal && x.texture_coordinate == y.texture_coordinate &&
           x.material == y.material;
  };
  return a.indices == b.indices &&
         std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(), equal);
}

// Is a text of faces among elements of few values, and what its model must be.
struct RandomFile {
  std::string text = "mtllib m.mtl\n";
  Model expected;

  explicit RandomFile(uint32_t seed) : random_(seed) {
    for (int block = 0; block < 60; ++block) {
      add_elements();
      if (block % 3 == 0) choose_material();
      for (int face = 0; face < 4; ++face) add_face();
    }
  }

 private:
  static constexpr const char* kNewlines[] = {"\n", "\r\n", "  \n"};

  uint32_t below(size_t count) {
    return std::uniform_int_distribution<uint32_t>(0, uint32_t(count) - 1)(random_);
  }
  float value() { return float(below(3)) / 2; }

  void add_elements() {
    for (int i = 0; i < 5; ++i) {
      const Vec3& p = positions_.emplace_back(value(), value(), value());
      text += fmt::format("v {} {} {}{}", p[0], p[1], p[2], kNewlines[below(3)]);
    }
    const Vec2& t = coordinates_.emplace_back(value(), value());
    text += fmt::format(" vt {} {}{}", t[0], t[1], kNewlines[below(3)]);
    const Vec3& n = normals_.emplace_back(value(), value(), 1);
    text += fmt::format("vn {} {} {}\n# a comment\n", n[0], n[1], n[2]);
  }

  void choose_material() {
    const uint32_t which = below(3);  // Material 2 is none of the library's, and stands for the first.
    text += fmt::format("usemtl {}\n", std::array{"a", "b", "none"}[which]);
    material_ = which == 1;
  }

  // Writes an index of one of `count` elements from 1 on or from the end.
  std::string name(uint32_t index, size_t count) {
    return below(2) ? std::to_string(index + 1) : std::to_string(int64_t(index) - int64_t(count));
  }

  void add_face() {
    const uint32_t corners = 2 + below(4);  // A face of two corners is left out.
    const bool has_coordinates = below(2), has_normals = below(2);
    std::vector<Vertex> fan;
    text += "f";
    for (uint32_t i = 0; i < corners; ++i) {
      const uint32_t p = below(positions_.size()), t = below(coordinates_.size()), n = below(normals_.size());
      text += ' ' + name(p, positions_.size());
      if (has_coordinates || has_normals) text += '/';
      if (has_coordinates) text += name(t, coordinates_.size());
      if (has_normals) text += '/' + name(n, normals_.size());
      fan.push_back({positions_[p], has_normals ? normals_[n] : Vec3{},
                     has_coordinates ? Vec2{coordinates_[t][0], 1 - coordinates_[t][1]} : Vec2{}, material_});
    }
    text += kNewlines[below(3)];
    for (uint32_t k = 2; k < corners; ++k)
      for (const uint32_t i : {0u, k - 1, k}) expected.indices.push_back(index_of(fan[i]));
  }

  uint32_t index_of(const Vertex& v) {
    const std::array key{v.position[0],    v.position[1], v.position[2],           v.normal[0],
                         v.normal[1],      v.normal[2],   v.texture_coordinate[0], v.texture_coordinate[1],
                         float(v.material)};
    const auto [at, is_new] = indices_.try_emplace(key, uint32_t(expected.vertices.size()));
    if (is_new) expected.vertices.push_back(v);
    return at->second;
  }

  std::mt19937 random_;
  std::vector<Vec3> positions_, normals_;
  std::vector<Vec2> coordinates_;
  int32_t material_ = 0;
  std::map<std::array<float, 9>, uint32_t> indices_;
};

}  // namespace

TEST_CASE("an OBJ file's polygons become fans of vertices shared by value in the order of first use") {
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl a\nKd 0.1 0.2 0.3\nnewmtl b\n");
  folder.write("t.obj",
               "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nvt 0.25 0.75\n"
               "usemtl b\nf 1/1 2/1 3/1 4/1\nusemtl a\nf 1/1 5/1 3/1\nf 1/1 2/1 3/1\n");
  std::vector<Material> materials(2);
  const Model model = load_obj((folder.path / "t.obj").string(), materials);
  REQUIRE(materials.size() == 4);
  CHECK(materials[2].diffuse == Vec4{0.1f, 0.2f, 0.3f, 1});
  CHECK(materials[3].diffuse == Vec4{0, 0, 0, 1});  // Kd is missing
  CHECK(model.indices == std::vector<uint32_t>{0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 5, 6});
  CHECK(model.vertices[0].material == 3);
  CHECK(model.vertices[4].material == 2);
  CHECK(model.vertices[0].texture_coordinate == Vec2{0.25f, 0.25f});  // v is turned over
  CHECK(model.vertices[0].normal == Vec3{0, 0, 1});                   // the file has none, so they are smooth
}

TEST_CASE("an OBJ file without a material library gets one grey") {
  const TemporaryFolder folder;
  folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  std::vector<Material> materials;
  load_obj((folder.path / "t.obj").string(), materials);
  REQUIRE(materials.size() == 1);
  CHECK(materials[0].diffuse == Vec4{0.7f, 0.7f, 0.7f, 1});
}

TEST_CASE("an OBJ file is the same model at any number of threads and with chunks of any size") {
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl a\nnewmtl b\n");
  for (const uint32_t seed : {1u, 2u, 3u}) {
    const RandomFile random(seed);
    REQUIRE(random.expected.indices.size() > 300);
    const std::string file = folder.write("random.obj", random.text);
    for (const size_t chunk_bytes : {size_t{1}, size_t{100}, size_t{3000}, random.text.size()})
      for (const uint32_t threads : {1u, 2u, 5u}) {
        CAPTURE(seed, chunk_bytes, threads);
        const Loaded loaded = load(file, threads, chunk_bytes);
        CHECK(loaded.materials.size() == 2);
        CHECK(same(loaded.model, random.expected));
      }
  }
}

TEST_CASE("smooth normals are the same at any number of threads") {
  const TemporaryFolder folder;
  std::string text;
  std::mt19937 random(5);
  for (int i = 0; i < 50; ++i)
    text += fmt::format("v {} {} {}\n", random() % 97, random() % 89, random() % 83);
  for (int i = 0; i < 300; ++i)
    text += fmt::format("f {} {} {}\n", 1 + random() % 50, 1 + random() % 50, 1 + random() % 50);
  const std::string file = folder.write("smooth.obj", text);
  const Loaded alone = load(file);
  CHECK(length(alone.model.vertices[0].normal) == Approx(1));
  for (const uint32_t threads : {2u, 7u, 64u}) CHECK(same(load(file, threads, 50).model, alone.model));
}

TEST_CASE("lines of an OBJ file may end with a carriage return alone") {
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl a\nnewmtl b\n");
  const Loaded loaded =
      load(folder.write("old.obj", "# old\rmtllib m.mtl\rv 0 0 0\rv 1 0 0\rv 0 1 0\rusemtl b\rf 1 2 3\r"));
  CHECK(loaded.model.indices == std::vector<uint32_t>{0, 1, 2});
  REQUIRE(loaded.model.vertices.size() == 3);
  CHECK(loaded.model.vertices[0].material == 1);
}

TEST_CASE("a mistake in an OBJ file is named by its line, whichever chunk it is in") {
  const TemporaryFolder folder;
  const std::string good = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  struct Mistake {
    std::string line, message;
  };
  const Mistake mistakes[] = {{"f 1 2 9", "this face names vertex 9, and the file has 6"},
                              {"f 1 2 -4", "this face names vertex -4, and 3 stand above it"},
                              {"f 1 /2 3", "the corner '/2' names no vertex"},
                              {"f 1 2//3/4 3", "this face names normal 3, and the file has 0"},
                              {"f 1 2///4 3", "the corner '2///4' has more than three numbers"},
                              {"v 1 x 2", "'x' is not a finite number"},
                              {"f 1 b 3", "'b' is not the number of a vertex"}};
  for (const Mistake& mistake : mistakes)
    for (const size_t chunk_bytes : {1, 20, 1000}) {
      CAPTURE(mistake.line, chunk_bytes);
      // The first mistake is named, although another thread may find one below it earlier.
      const std::string message =
          error_of(folder.write("bad.obj", good + mistake.line + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 77\n"),
                   chunk_bytes);
      CHECK(message.find("bad.obj:5") != std::string::npos);
      CHECK(message.find(mistake.message) != std::string::npos);
    }
}

TEST_CASE("a material library that is absent is an error") {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("t.obj", "mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
  CHECK(error_of(file, 1).find("its material library cannot be read") != std::string::npos);
}
