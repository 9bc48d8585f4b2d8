// Tests scenes that are folders of OBJ files: their models, copies, materials and textures.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/asset_folder.h"

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "pictures/encode.h"
#include "scenes/lumibench/builders.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using glint::test::TemporaryFolder;
using namespace glint::scenes;

namespace {

// Is a folder with two files that have triangles, one that has none, and two copies of the first.
struct ObjFolder : TemporaryFolder {
  ObjFolder() {
    const std::vector<float> grey(4, 0.5f);
    write("grey.png", glint::pictures::png_bytes({1, 1, grey}));
    write("b.mtl", "newmtl one\nKd 0 0 0\nmap_Kd grey.png\nnewmtl two\nKd 0 1 0\n");
    write("b.obj", "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl two\nf 1 2 3\nusemtl one\nf 3 2 1\n");
    write("c.obj", "v 0 0 0\n");
    write("e.mtl", "newmtl red\nKd 1 0 0\nmap_Kd grey.png\n");
    write("e.obj", "mtllib e.mtl\nv 0 0 1\nv 1 0 1\nv 0 1 1\nusemtl red\nf 1 2 3\n");
    write("a.mtl", "newmtl blue\nKd 0 0 1\n");
    write("f.mtl", "newmtl white\nKd 1 1 1\nnewmtl black\nKd 0 0 0\n");
    write("instances.tsv", "a.obj b.obj 1 0 0 5 0 1 0 0 0 0 1 0\nf.obj b.obj 1 0 0 7 0 1 0 0 0 0 1 0\n");
  }
};

Scene load_all(const ObjFolder& folder, uint32_t threads) {
  Scene scene;
  load_folder(scene, folder.path.string(), {.threads = threads},
              {.textures = true, .scale = 2, .colors = {{{"e"}, lambertian(0.25f, 0.25f, 0.25f)}}});
  return scene;
}

TEST_CASE("a folder gives its files and copies as models in the order of their names") {
  const Scene scene = load_all(ObjFolder(), 1);

  std::vector<std::string> names;
  for (const Model& model : scene.models) names.push_back(model.name);
  CHECK(names == std::vector<std::string>{"a", "b", "e", "f"});
  CHECK(scene.models[0].vertices[0].position == Vec3{10, 0, 0});  // moved by 5, then scaled
  CHECK(scene.models[1].vertices[1].position == Vec3{2, 0, 0});
  CHECK(scene.models[3].vertices[0].position == Vec3{14, 0, 0});
}

TEST_CASE("models of a folder keep their materials and textures apart") {
  const Scene scene = load_all(ObjFolder(), 1);

  REQUIRE(scene.materials.size() == 6);  // blue; one, two; e's; white, black
  CHECK(scene.materials[0].diffuse == Vec4{0, 0, 1, 1});
  for (const Vertex& vertex : scene.models[0].vertices) CHECK(vertex.material == 0);
  CHECK(scene.models[1].vertices.front().material == 2);
  CHECK(scene.models[1].vertices.back().material == 1);
  CHECK(scene.materials[1].texture == 0);
  CHECK(scene.materials[1].diffuse == Vec4{1, 1, 1, 1});
  CHECK(scene.models[2].vertices[0].material == 3);
  CHECK(scene.materials[3].diffuse == Vec4{0.25f, 0.25f, 0.25f, 1});  // the folder's rule
  CHECK(scene.models[3].vertices.front().material == 5);              // the second of its own, as in its base
  REQUIRE(scene.textures.size() == 2);                                // those of b and of e
  CHECK(scene.textures[0].rgba == std::vector<uint8_t>{128, 128, 128, 255});
}

TEST_CASE("a folder is the same scene at any number of threads, and names the same damaged file") {
  const ObjFolder folder;
  const Scene one = load_all(folder, 1);
  for (const uint32_t threads : {2u, 5u}) CHECK(load_all(folder, threads).hash() == one.hash());

  folder.write("d.obj", "v 0 0 0\nf 1 2 3\n");
  folder.write("g.obj", "v 0 0 0\nf 4 5 6\n");
  for (const uint32_t threads : {1u, 4u}) {
    try {
      load_all(folder, threads);
      FAIL("damaged files were read");
    } catch (const glint::UserError& error) {
      CHECK_THAT(error.what(), Catch::Contains("d.obj"));
    }
  }
}

}  // namespace
