// Builds PARK: long thin grass close to the camera, trees, a car and mountains on a procedural ground sphere.
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "base/diagnostics.h"
#include "scenes/generate/figures.h"
#include "scenes/generate/generated.h"
#include "scenes/generate/plants.h"
#include "scenes/import/asset_folder.h"
#include "scenes/import/obj_loader.h"

namespace glint::scenes {
namespace {

constexpr float kScale = 0.1f;  // the application's scale of every file

const Material kLeaf = paint(124, 252, 0), kRock = paint(136, 140, 141), kSoil = paint(155, 118, 83),
               kWood = paint(114, 92, 66), kSkin = paint(197, 140, 133),
               kCar = metallic(200.0f / 256, 200.0f / 256, 200.0f / 256, 0.2f);

FolderRules rules() {
  return {.scale = kScale,
          .colors = {{{"leaves", "grass"}, kLeaf},
                     {{"mountain"}, kRock},
                     {{"ground"}, kSoil},
                     {{"tree"}, kWood},
                     {{"human"}, kSkin},
                     {{"Benz"}, kCar}}};
}

// Adds the mountains of a stand-in table: nx * nz vertices over a rectangle.
void add_heights(Model& model, std::istream& fields, int32_t material) {
  uint32_t nx = 0, nz = 0;
  float x0 = 0, z0 = 0, x1 = 0, z1 = 0, base = 0, height = 0, seed = 0;
  fields >> nx >> nz >> x0 >> z0 >> x1 >> z1 >> base >> height >> seed;
  add_patch(model, 2 * uint64_t(nx - 1) * (nz - 1), float(nx - 1) / float(nz - 1), material,
            [=](float u, float v) -> Vec3 {
              const float hill = sine(3.14159265 * double(u)) * sine(3.14159265 * double(v));
              return {x0 + (x1 - x0) * u, base + height * hill * (0.6f + fractal({u * 6, seed, v * 6}, 5)),
                      z0 + (z1 - z0) * v};
            });
}

// Reads objects that a table `standin.tsv` puts together from other scenes' files. A line has a name, a file
// or HF, and a matrix or heights.
class StandIns {
 public:
  StandIns(Scene& scene, std::filesystem::path folder) : scene_(scene), folder_(std::move(folder)) {}

  bool run() {
    std::ifstream table(folder_ / "standin.tsv");
    for (std::string line; std::getline(table, line);)
      if (!line.empty() && line[0] != '#') add(line);
    for (auto& [name, model] : objects_) {
      for (Vertex& vertex : model.vertices) vertex.position = vertex.position * kScale;
      scene_.models.push_back(std::move(model));
    }
    return !objects_.empty();
  }

 private:
  void add(const std::string& line) {
    std::istringstream fields(line);
    std::string file_name, base;
    fields >> file_name >> base;
    const std::string name = std::filesystem::path(file_name).stem().string();
    Model& model = objects_[name];
    model.name = name;
    const int32_t material = material_of(name);
    if (base == "HF") return add_heights(model, fields, material);
    Affine matrix = kIdentity;
    for (size_t i = 0; i < 12; ++i) fields >> matrix[i / 4][i % 4];
    if (!fields)
      throw UserError({(folder_ / "standin.tsv").string()}, "this line is not a copy: " + line,
                      "expected: name, file, 12 numbers");
    append_copy(model, base_of(base), matrix, material);
  }

  const Model& base_of(const std::string& base) {
    if (!bases_.contains(base)) {
      std::vector<Material> unused;
      bases_[base] = load_obj((folder_.parent_path() / base).string(), unused);
    }
    return bases_[base];
  }

  int32_t material_of(const std::string& name) {
    const FolderRules colors = rules();
    for (const NameRule& rule : colors.colors)
      for (const std::string& part : rule.parts)
        if (name.find(part) != std::string::npos) {
          if (!materials_.contains(name)) {
            materials_[name] = add_material(scene_, name, rule.material);
          }
          return materials_[name];
        }
    throw UserError({(folder_ / "standin.tsv").string()}, "this table has no colour for the object " + name,
                    "expected one of the scene's own names");
  }

  Scene& scene_;
  std::filesystem::path folder_;
  std::map<std::string, Model> objects_, bases_;
  std::map<std::string, int32_t> materials_;
};

void load(Scene& scene, const std::string& folder, const LoadOptions& options) {
  load_folder(scene, folder, options, rules());
  if (scene.form == "original" || !StandIns(scene, folder).run()) return;
  scene.form = "stand-in";
  scene.note =
      "The humans and the ground are the original's, grass, trees and car are put together from other "
      "scenes' files, and the mountains are generated.";
}

float lawn(float x, float z) {
  return 0.075f + 0.02f * fractal({x * 1.2f, 0, z * 1.2f}, 2);
}

void add_car(Model& model, const Frame& f, int32_t material) {
  add_rounded_box(model, f.inner({0, 0.35f, 0}, {1, 0.32f, 0.45f}), 40'000, material, 0.3f);
  add_rounded_box(model, f.inner({-0.1f, 0.8f, 0}, {0.65f, 0.3f, 0.4f}), 30'000, material, 0.4f);
  for (int k = 0; k < 4; ++k)
    add_ring(model,
             {f.x * 0.2f, f.z * 0.08f, f.y * 0.2f, f.at(k % 2 ? 0.6f : -0.6f, 0.15f, k / 2 ? 0.43f : -0.43f)},
             24'000, material, 0.4f);
}

void trees(Generator& generator, int32_t wood_material, int32_t leaf_material) {
  static constexpr const char* kNames[] = {"tree", "tree_001", "tree_002"};
  for (uint32_t k = 0; k < 9; ++k) {
    Model wood, leaves;
    for (uint32_t t = 0; t < 3; ++t) {
      const uint32_t n = 3 * k + t;
      const float depth = 1.6f + 0.13f * float(n), side = float(n * 7 % 11) / 11 - 0.5f;
      const Vec3 foot{1.6f - depth, 0.07f, 0.6f - 0.33f * depth + side * (0.9f + 0.5f * depth)};
      add_tree(wood, leaves,
               {.foot = foot,
                .height = 0.5f + 0.05f * float(n % 5),
                .spread = 0.6f,
                .leaf = 0.02f,
                .wood = 0.34f,
                .bark = wood_material,
                .leaves = leaf_material,
                .seed = n + 21},
               304'000 / 3);
    }
    generator.model(kNames[k / 3], [&](Model& m) {
      m.vertices = std::move(wood.vertices);
      m.indices = std::move(wood.indices);
    });
    generator.model("leaves", [&](Model& m) {
      m.vertices = std::move(leaves.vertices);
      m.indices = std::move(leaves.indices);
    });
  }
}

void generate(Scene& scene, const LoadOptions& options) {
  constexpr uint64_t kTriangles = 6'000'000;
  Generator generator(scene, options, kTriangles);
  const int32_t leaf = generator.material("leaf", kLeaf), rock = generator.material("rock", kRock),
                soil = generator.material("soil", kSoil);
  const int32_t wood = generator.material("wood", kWood), skin = generator.material("skin", kSkin),
                metal = generator.material("metal", kCar);
  trees(generator, wood, leaf);
  for (uint32_t k = 0; k < 2; ++k) {
    generator.model("mountain", [&](Model& m) {
      add_ground(
          m, {-10, k ? 0.0f : -7.5f}, {-3.5f, k ? 8.0f : 0.5f},
          [k](float x, float z) {
            const float edge = (x + 10) * (-3.5f - x) / 10.5f,
                        ends = k ? z * (8 - z) / 16 : (z + 7.5f) * (0.5f - z) / 16;
            return 2.2f * edge * ends * (0.6f + fractal({x * 0.9f, float(k), z * 0.9f}, 5));
          },
          362'000, rock);
    });
    generator.model("human", [&](Model& m) {
      const Frame frame = upright(k ? Vec3{0.18f, 0.08f, -0.26f} : Vec3{0.7f, 0.08f, 0.27f},
                                  {0.205f, 0.205f, 0.205f}, k ? -60.0f : 80.0f);
      add_figure(m, frame, {.skirt = k == 1}, 38'000, {skin, skin, skin, skin, skin, skin});
    });
  }
  generator.model("Benz", [&](Model& m) {
    add_car(m, upright({-0.3f, 0.07f, 0.25f}, {0.22f, 0.13f, 0.22f}, 60), metal);
  });
  generator.model("ground", [&](Model& m) {
    add_ground(m, {-5.26f, -4.29f}, {4.02f, 5.1f}, lawn, 1'352, soil);
  });
  for (uint32_t k = 0; k < 12; ++k) {
    const uint64_t share = generator.rest() / (12 - k);
    generator.model("grass", [&](Model& m) {
      const float x = 1.35f - 0.42f * float(k / 2), z = k % 2 ? 0.35f : -0.75f;
      add_grass(m, {x - 0.45f, z - 0.2f}, {x + 0.25f, z + 0.9f}, lawn, 0.14f, share, leaf, k);
    });
  }
  scene.note =
      "The scene is a procedural park with about the original's triangle count (6.0M), its 36 models and the "
      "ground sphere.";
}

}  // namespace

Scene build_park(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "PARK";
  scene.camera = {.eye = {2, 0.5f, 0.75f},
                  .target = {0, 0.3f, 0},
                  .field_of_view = 30,
                  .aperture = 0.0001f,
                  .focus_distance = 2};
  add_material(scene, "ground_sphere", lambertian(0.5f, 0.5f, 0.5f));
  scene.models.push_back(make_sphere("ground_sphere", {0, -1000, 0}, 1000, 0));
  original.empty() ? generate(scene, options) : load(scene, original, options);
  return scene;
}

}  // namespace glint::scenes
