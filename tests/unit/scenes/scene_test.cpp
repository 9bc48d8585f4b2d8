// Tests the other scenes: counts, bounds, normals, hashes and errors.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "base/diagnostics.h"
#include "scenes/generate/distance_field.h"
#include "scenes/mesh.h"
#include "tests/support/catch.h"
#include "tests/support/scene_data.h"
#include "tests/support/temporary_folder.h"

using glint::test::TemporaryFolder;
using namespace glint::scenes;

namespace {

std::string message_of(const std::string& name, const LoadOptions& options) {
  try {
    load_scene(name, options);
  } catch (const glint::UserError& error) {
    return error.what();
  }
  return "no error";
}

// Counts half edges without a partner of the opposite direction. There are none on a closed surface of one
// orientation.
size_t open_edges(const Model& model) {
  std::vector<std::pair<uint32_t, uint32_t>> forward, backward;
  for (size_t i = 0; i < model.indices.size(); i += 3)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = model.indices[i + k], b = model.indices[i + (k + 1) % 3];
      forward.push_back({a, b});
      backward.push_back({b, a});
    }
  std::sort(forward.begin(), forward.end());
  std::sort(backward.begin(), backward.end());
  size_t open = 0;
  for (size_t i = 0; i < forward.size(); ++i) open += forward[i] != backward[i];
  return open;
}

}  // namespace

TEST_CASE("the Cornell box has 24 vertices, 12 triangles and walls that face inward") {
  const Scene scene = load_scene("CORNELL", {});
  const Model& box = scene.models.at(0);
  CHECK(box.vertices.size() == 24);
  CHECK(scene.triangles() == 12);
  const Bounds b = bounds(box);
  CHECK(b.lower == Vec3{0, 0, -555});
  CHECK(b.upper == Vec3{555, 555, 0});
  const Vec3 middle{277.5f, 277.5f, -277.5f};
  for (size_t i = 0; i < box.indices.size(); i += 3) {
    const Vertex &a = box.vertices[box.indices[i]], &p = box.vertices[box.indices[i + 1]],
                 &q = box.vertices[box.indices[i + 2]];
    CHECK(normalized(cross(p.position - a.position, q.position - a.position)) == a.normal);
    CHECK(dot(a.normal, middle - a.position) > 0);
  }
  CHECK(box.vertices[0].normal == Vec3{1, 0, 0});
  CHECK(box.vertices[0].material == 1);  // green, at x = 0
  CHECK(scene.materials[3].model == MaterialModel::DiffuseLight);
}

TEST_CASE("the diffuse lamp of the box hangs at 0.998 of its height over the stated rectangle") {
  const Model box = load_scene("CORNELL", {}).models.at(0);
  for (size_t i = 20; i < 24; ++i) {
    const Vec3 p = box.vertices[i].position;
    CHECK(p[1] == 0.998f * 555.0f);
    CHECK((p[0] == 213 || p[0] == 343));
    CHECK((p[2] == -223 || p[2] == -328));
  }
}

TEST_CASE("generated meshes say what they are and have the original's size and number of triangles") {
  struct Expected {
    const char* name;
    const char* form;
    uint64_t triangles, tolerance;
    size_t materials;
  };
  for (const Expected& e : {Expected{"BUNNY", "built-in", 144058, 1500, 5},
                            {"REF", "built-in", 448912, 4500, 6},
                            {"SHIP", "built-in", 6255, 60, 11}}) {
    const Scene scene = load_scene(e.name, {});
    INFO(e.name << ": " << scene.triangles());
    CHECK(scene.form == e.form);
    CHECK(scene.triangles() >= e.triangles - e.tolerance);
    CHECK(scene.triangles() <= e.triangles + e.tolerance);
    CHECK(scene.materials.size() == e.materials);
    std::set<int32_t> used;
    for (const Model& model : scene.models)
      for (const Vertex& v : model.vertices) used.insert(v.material);
    CHECK(used.size() == e.materials);
    CHECK((*used.begin() == 0 && *used.rbegin() == int32_t(e.materials) - 1));
  }
}

TEST_CASE("the sculpted stand-ins are closed surfaces inside the box, upright on the floor") {
  for (const char* name : {"BUNNY", "REF"}) {
    const Scene scene = load_scene(name, {});
    const Model& mesh = scene.models.back();
    INFO(name);
    CHECK(open_edges(mesh) == 0);
    const Bounds b = bounds(mesh);
    CHECK((b.lower[0] > 0 && b.upper[0] < 555 && b.lower[2] > -555 && b.upper[2] < 0));
    CHECK(b.lower[1] > -1);
    CHECK(b.lower[1] < 6);
    CHECK(b.upper[1] > 300);
    CHECK(b.upper[1] < 370);
  }
}

TEST_CASE("the built-in ship fills the original's bounds, placed as the original") {
  const Bounds b = bounds(load_scene("SHIP", {}).models.at(0));
  CHECK(b.lower[1] == Approx(-9 - 136).margin(1));
  CHECK(b.upper[1] == Approx(-9 + 1543).margin(1));
}

TEST_CASE("REF has mirror walls, a glass sphere of radius 80, and no sky") {
  const Scene scene = load_scene("ref", {});
  CHECK(scene.procedurals() == 1);
  CHECK(scene.models[1].center == Vec3{425, 165, -147.5f});
  CHECK(scene.materials[0].model == MaterialModel::Metallic);
  CHECK(scene.materials[4].refraction_index == 1.5f);
  CHECK_FALSE(scene.camera.has_sky);
}

TEST_CASE("a scene's hash is the same on every machine and changes with every field") {
  // These hashes are recorded. When they change, the scenes that every result was measured on have changed,
  // or the way in which a scene is hashed.
  CHECK(load_scene("WKND", {}).hash() == 0x3f517b6c35accd63);
  CHECK(load_scene("CORNELL", {}).hash() == 0xb0b32b1e42f4805a);
  Scene scene = load_scene("CORNELL", {});
  const uint64_t before = scene.hash();
  scene.models[0].vertices[3].texture_coordinate[1] += 1;
  const uint64_t moved = scene.hash();
  CHECK(moved != before);
  scene.camera.light_radius = 11;
  CHECK(scene.hash() != moved);
}

TEST_CASE("a scene's hash depends on its last index and texel and not on the threads") {
  Scene scene = load_scene("BUNNY", {});
  scene.textures.push_back({"odd", 3, 1, std::vector<uint8_t>(12, 7)});
  const uint64_t before = scene.hash();
  for (const uint32_t threads : {2u, 3u, 8u}) CHECK(scene.hash(threads) == before);
  scene.textures.back().rgba[11] = 8;
  const uint64_t other_texel = scene.hash();
  CHECK(other_texel != before);
  scene.models.back().indices.back() ^= 1;
  CHECK(scene.hash() != other_texel);
}

TEST_CASE("building a scene twice gives the same bytes") {
  for (const char* name : {"BUNNY", "SHIP"})
    CHECK(load_scene(name, {}).hash() == load_scene(name, {}).hash());
}

TEST_CASE("an unknown scene is a user error that names the nearest one") {
  CHECK(message_of("BUNNI", {}).find("did you mean 'BUNNY'?") != std::string::npos);
  CHECK(message_of("SHIPP", {}).find("unknown scene 'SHIPP'") != std::string::npos);
}

TEST_CASE("a missing asset is a user error that says which file belongs where") {
  const TemporaryFolder folder;
  const std::string message = message_of("SHIP", {folder.path.string()});
  CHECK(message.find("assets/models/karimSchooner.obj") != std::string::npos);
  CHECK(message.find("SHIP/karimSchooner.obj") != std::string::npos);
  CHECK(message.find(folder.path.string()) != std::string::npos);
}

TEST_CASE("the data of an original is found as a file, or as a folder that holds OBJ files") {
  const TemporaryFolder folder;
  const std::string assets = folder.path.string();
  std::filesystem::create_directories(folder.path / "FOX");
  folder.write("FOX/head.mtl", "newmtl m\n");
  CHECK_FALSE(has_original("SHIP", assets));
  CHECK_FALSE(has_original("FOX", assets));
  CHECK(message_of("FOX", {assets}).find("Scenes/Blender_2.90, assets/Scenes/Blender_2.90, FOX") !=
        std::string::npos);
  folder.write("SHIP/karimSchooner.obj", "v 0 0 0\n");
  folder.write("FOX/tail.obj", "v 0 0 0\n");
  CHECK(has_original("ship", assets));
  CHECK(has_original("FOX", assets));
  CHECK(has_original("FOX", ""));
  CHECK(has_original("WKND", assets));
}

TEST_CASE("the original ship loads with 6,255 triangles and 11 materials from the unpacked archive") {
  const glint::test::SceneData data("SHIP");
  if (data.path.empty()) return;
  const Scene scene = load_scene("SHIP", {data.path});
  // The folder itself is accepted, too.
  CHECK(load_scene("SHIP", {data.path + "/SHIP"}).hash() == scene.hash());
  CHECK(scene.form == "original");
  CHECK(scene.triangles() == 6255);
  CHECK(scene.materials.size() == 11);
  CHECK(bounds(scene.models[0]).upper[1] == Approx(-9 + 1543).margin(1));
}

TEST_CASE("the diagonal is that of the box around all instances in the world") {
  Scene scene;
  CHECK(diagonal(scene) == 0);
  add_vertex(scene.models.emplace_back(), {0, 0, 0}, {}, 0);
  add_vertex(scene.models[0], {1, 2, 2}, {}, 0);
  CHECK(diagonal(scene) == 3);
  scene.instances.resize(2);
  scene.instances[1].to_world =
      Affine{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 4};  // swaps x and y, and moves along z
  CHECK(diagonal(scene) == Approx(std::sqrt(4.0f + 4.0f + 36.0f)));
}

TEST_CASE("placing turns by a right-handed angle about y, then scales, then moves") {
  Model model;
  add_vertex(model, {1, 2, 0}, {1, 0, 0}, 0);
  place(model, {.translation = {10, 0, 0}, .scale = 2, .rotation_y = 90});
  CHECK(model.vertices[0].position[0] == Approx(10).margin(1e-6));
  CHECK(model.vertices[0].position[1] == 4);
  CHECK(model.vertices[0].position[2] == Approx(-2));
  CHECK(model.vertices[0].normal[2] == Approx(-0.5));
}

TEST_CASE("a surface is the same at any number of threads, and where its blocks are cut") {
  // The lattice has blocks that are skipped as a whole, and a body that is thinner than a fine block.
  const auto field = [](const Vec3& p) {
    const float disc = std::max(std::sqrt(p[0] * p[0] + p[2] * p[2]) - 1.5f, std::abs(p[1] - 0.21f) - 0.02f);
    return std::min(length(p - Vec3{0.3f, 1, 0}) - 0.4f, disc);
  };
  const Bounds box{{-1.8f, -1.3f, -1.8f}, {1.8f, 1.7f, 1.8f}};
  const Model one = surface_of(field, box, 0.05f, 7), three = surface_of(field, box, 0.05f, 7, 3);
  CHECK(open_edges(one) == 0);
  CHECK(one.indices.size() > 10'000);
  REQUIRE(one.vertices.size() == three.vertices.size());
  CHECK(one.indices == three.indices);
  for (size_t i = 0; i < one.vertices.size(); ++i) {
    REQUIRE(one.vertices[i].position == three.vertices[i].position);
    REQUIRE(one.vertices[i].normal == three.vertices[i].normal);
  }
}

TEST_CASE("the surface of a sphere's distance field is closed and lies on the sphere with outward normals") {
  const auto field = [](const Vec3& p) { return length(p) - 1; };
  const Model model = surface_of(field, {{-1.3f, -1.3f, -1.3f}, {1.3f, 1.3f, 1.3f}}, 0.05f, 7);
  CHECK(open_edges(model) == 0);
  CHECK(model.indices.size() / 3 == 2 * (model.vertices.size() - 2));  // Euler's formula for one sphere
  for (const Vertex& v : model.vertices) {
    REQUIRE(length(v.position) == Approx(1).margin(0.003));
    REQUIRE(dot(v.normal, v.position) > 0.99f);
  }
}
