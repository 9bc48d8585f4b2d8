// Builds SPNZA, a colonnaded hall with two floors of arches, curtains and textured walls, as one structure.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

#include "scenes/generate/generated.h"
#include "scenes/generate/paintings.h"
#include "scenes/generate/plants.h"
#include "scenes/generate/solids.h"
#include "scenes/import/asset_folder.h"
#include "scenes/import/obj_loader.h"
#include "scenes/import/texture_loader.h"

namespace glint::scenes {
namespace {

constexpr float kStandInScale = 107;  // units of the original per metre of the stand-in

struct StandInTexture {
  std::vector<std::string> parts;  // parts of a file's name; the first entry with one of them applies
  const char* texture;
};

// Returns which of the original's textures the stand-in's parts carry. They show surfaces of the same kind.
const std::vector<StandInTexture>& stand_in_textures() {
  static const std::vector<StandInTexture> table = {
      {{"arcs_", "holes", "parapet", "object19", "object27", "object4"}, "sponza_arch_diff"},
      {{"walls-lib_0", "outside01"}, "spnza_bricks_a_diff"},
      {{"ceiling", "object21"}, "sponza_ceiling_a_diff"},
      {{"floors"}, "sponza_floor_a_diff"},
      {{"pillar_floor", "puillar_floor_corner"}, "sponza_column_a_diff"},
      {{"pillar_round", "pillar_corners"}, "sponza_column_b_diff"},
      {{"object5", "object6", "object23", "object32"}, "sponza_details_diff"},
      {{"pillar_quader", "object3-", "object28", "object31"}, "sponza_column_c_diff"},
      {{"windows", "walls-lib_1"}, "sponza_flagpole_diff"},
      {{"doors", "walls-lib_2"}, "sponza_roof_diff"},
      {{"relief"}, "lion"},
      {{"unnamed_0"}, "vase_round"}};
  return table;
}

int32_t stand_in_material(Scene& scene, const std::string& name, const std::filesystem::path& textures) {
  const auto& table = stand_in_textures();
  const auto found = std::find_if(table.begin(), table.end(), [&](const StandInTexture& entry) {
    return std::any_of(entry.parts.begin(), entry.parts.end(),
                       [&](const std::string& part) { return name.find(part) != std::string::npos; });
  });
  const char* file = found == table.end() ? "background" : found->texture;
  for (size_t k = 0; k < scene.materials.size(); ++k)
    if (scene.textures[size_t(scene.materials[k].texture)].name == file) return int32_t(k);
  scene.textures.push_back(load_texture((textures / (std::string(file) + ".png")).string()));
  add_material(scene, file, lambertian(1, 1, 1));
  scene.materials.back().texture = int32_t(scene.textures.size() - 1);
  return int32_t(scene.materials.size() - 1);
}

// Returns a model in which every triangle is cut into four at the middles of its edges.
Model subdivided(const Model& model) {
  Model fine;
  const auto middle = [](const Vertex& a, const Vertex& b) {
    Vertex m = a;
    m.position = (a.position + b.position) * 0.5f;
    m.normal = normalized(a.normal + b.normal);
    for (size_t k = 0; k < 2; ++k)
      m.texture_coordinate[k] = 0.5f * (a.texture_coordinate[k] + b.texture_coordinate[k]);
    return m;
  };
  for (size_t i = 0; i < model.indices.size(); i += 3) {
    const Vertex &a = model.vertices[model.indices[i]], &b = model.vertices[model.indices[i + 1]],
                 &c = model.vertices[model.indices[i + 2]];
    const auto first = uint32_t(fine.vertices.size());
    for (const Vertex& v : {a, b, c, middle(a, b), middle(b, c), middle(c, a)}) fine.vertices.push_back(v);
    for (const uint32_t corner : {0, 3, 5, 3, 1, 4, 5, 4, 2, 3, 4, 5}) fine.indices.push_back(first + corner);
  }
  return fine;
}

void load_stand_in(Scene& scene, const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".obj") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  Model all;
  for (const fs::path& file : files) {
    std::vector<Material> unused;
    const int32_t material =
        stand_in_material(scene, file.stem().string(), folder.parent_path() / "textures");
    constexpr float s = kStandInScale;
    append_copy(all, load_obj(file.string(), unused), {s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0}, material);
  }
  scene.models.push_back(subdivided(all));
  scene.models.back().name = "sponza_stand_in";
  scene.form = "stand-in";
  scene.note =
      "The mesh is an earlier model of the same building with every triangle cut in four (271,708), and with "
      "the original's textures.";
}

void load(Scene& scene, const std::filesystem::path& path, uint32_t threads) {
  if (path.filename() == "sponza.obj") {
    scene.models.push_back(
        load_obj(path.string(), scene.materials, {.textures = &scene.textures, .threads = threads}));
    scene.form = "original";
    scene.note = "The mesh and the textures are from the assets folder.";
  } else {
    load_stand_in(scene, path.parent_path());
  }
  place(scene.models.back(), {.rotation_y = 270});
}

// These are the sizes of the generated hall. Its long axis is z, the floor is y = 0, and the court lies
// between the columns at |x| = kColumns.
constexpr float kHalfWidth = 560, kColumns = 260, kHalfLength = 1860, kFloor = 420, kHeight = 1500;
constexpr uint32_t kBays = 12;  // columns on a side
constexpr uint32_t kIvy = 850;  // leaves in a bay

struct Hall {
  Generator& generator;
  std::vector<int32_t> paint;  // 24 textures, as many as the original's
  Model model{};

  void rectangle(const Vec3& corner, const Vec3& side, const Vec3& other, int32_t material,
                 uint64_t triangles) {
    add_patch(model, triangles, length(side) / length(other), material,
              [&](float u, float v) { return corner + side * u + other * v; });
  }
  void columns(float side, float z, float floor) {
    static constexpr Vec2 kProfile[] = {{-1, 0.9f}, {-0.95f, 1},  {-0.85f, 1},    {-0.8f, 0.7f},
                                        {0, 0.68f}, {0.8f, 0.6f}, {0.85f, 0.95f}, {1, 1}};
    const float low = floor * kFloor;
    add_lathe(model, upright({side * kColumns, low + 130, z}, {34, 130, 34}), kProfile, 500,
              paint[floor > 0 ? 5 : 4]);
    add_rounded_box(model, upright({side * kColumns, low + 10, z}, {42, 12, 42}), 150, paint[6]);
    add_rounded_box(model, upright({side * kColumns, low + 270, z}, {46, 12, 46}), 150, paint[6]);
    for (uint32_t leaf = 0; leaf < 8; ++leaf) {  // leaves that bend out of the capital
      const double angle = 6.283185307 * leaf / 8;
      const Vec3 out{cosine(angle), 0, sine(angle)}, wide{-out[2] * 10, 0, out[0] * 10};
      add_patch(model, 40, 1, paint[6], [&](float u, float v) {
        return Vec3{side * kColumns, low + 225 + 32 * v, z} + out * (24 + 16 * v * v) +
               wide * ((2 * u - 1) * (1 - v * v));
      });
    }
  }
  // Adds what lies between two columns: the inside of a half ring, and the wall above it.
  void arch(float side, float z0, float z1, float floor) {
    const float low = floor * kFloor + 282, middle = 0.5f * (z0 + z1), radius = 0.5f * (z1 - z0) - 34,
                top = (floor + 1) * kFloor;
    const auto rim = [&](float u) -> Vec3 {
      const double angle = 3.14159265358979 * double(u);
      return {side * kColumns, std::min(low + radius * sine(angle), top - 12),
              middle - radius * cosine(angle)};
    };
    add_patch(model, 160, 4, paint[7], [&](float u, float v) {
      return rim(u) + Vec3{(v - 0.5f) * 70, 0, 0};
    });
    for (const float face : {-35.0f, 35.0f})
      add_patch(model, 120, 4, paint[8], [&](float u, float v) {
        const Vec3 p = rim(u);
        return Vec3{p[0] + face, p[1] + (top - p[1]) * v,
                    z0 + (z1 - z0) * u + (p[2] - z0 - (z1 - z0) * u) * (1 - v)};
      });
  }
  // Adds what stands, hangs and grows in a bay: a plant, the balustrade of the gallery, ribs of the vaults,
  // and ivy that hangs down from the gallery.
  void furnish(float side, float z0, float z1, uint32_t k) {
    const float inner = side * kColumns, wall = side * kHalfWidth, middle = 0.5f * (z0 + z1);
    add_bush(model, upright({side * 160, 88, z0}, {44, 52, 44}), 1'000, paint[22], 15, k);
    for (uint32_t post = 0; post < 12; ++post)
      add_cable(model, {inner, kFloor + 20, z0 + (z1 - z0) * (float(post) + 0.5f) / 12},
                {inner, kFloor + 95, z0 + (z1 - z0) * (float(post) + 0.5f) / 12}, 0, 6, 48, paint[7]);
    add_rounded_box(model, upright({inner, kFloor + 100, middle}, {14, 8, 0.5f * (z1 - z0)}), 150, paint[8]);
    for (const float floor : {0.0f, 1.0f}) {
      const float top = (floor + 1) * kFloor - 16;
      add_cable(model, {inner, top - 110, z0}, {wall, top - 110, z1}, -26, 6, 96, paint[8]);
      add_cable(model, {inner, top - 110, z1}, {wall, top - 110, z0}, -26, 6, 96, paint[8]);
    }
    Random random(31 * k + (side < 0 ? 0 : 7));
    for (uint32_t leaf = 0; leaf < kIvy; ++leaf) {
      const float drop = random.next() * random.next(), size = random.between(6, 13);
      const Vec3 place{inner - side * random.between(20, 60 + 40 * drop), kFloor + 60 - 330 * drop,
                       random.between(z0, z1)};
      const Vec3 along = random.direction() * size, across = random.direction() * size;
      add_quad(model, place, along, across, paint[23]);
    }
  }
  void side_of(float side) {
    const float wall = side * kHalfWidth, inner = side * kColumns;
    for (uint32_t k = 0; k < kBays; ++k) {
      const float bay = 2 * kHalfLength / kBays, z = -kHalfLength + bay * (float(k) + 0.5f);
      for (const float floor : {0.0f, 1.0f}) {
        columns(side, z, floor);
        if (k + 1 < kBays) arch(side, z, z + bay, floor);
      }
      if (k + 1 < kBays) furnish(side, z, z + bay, k);
      if (k % 2 == 0)
        add_cloth(model, {{80, 0, 0}, {0, 150, 0}, {0, 0, 35}, {side * (kColumns - 60), 560, z + bay / 2}},
                  1200, paint[9 + k % 3], 5, k);
      add_lathe(model, upright({side * 160, 25, z}, {28, 25, 28}),
                std::array<Vec2, 4>{{{-1, 0.5f}, {0, 1}, {0.7f, 0.6f}, {1, 0.8f}}}, 400, paint[12]);
    }
    for (const float floor : {0.0f, 1.0f})  // gallery ceilings
      rectangle({wall, (floor + 1) * kFloor - 8, -kHalfLength}, {inner - wall, 0, 0}, {0, 0, 2 * kHalfLength},
                paint[2], 600);
    rectangle({wall, 0, -kHalfLength}, {0, 0, 2 * kHalfLength}, {0, 2 * kFloor, 0}, paint[1], 900);
    rectangle({inner, 2 * kFloor, -kHalfLength}, {0, 0, 2 * kHalfLength}, {0, kHeight - 2 * kFloor, 0},
              paint[0], 900);
    for (uint32_t k = 0; k < 24; ++k) {  // windows and doors
      const float z = -kHalfLength + 2 * kHalfLength * (float(k) + 0.5f) / 24;
      add_rounded_box(model, upright({k % 2 ? inner : wall, k % 2 ? 1050.0f : 160.0f, z}, {14, 110, 50}), 240,
                      paint[13 + k % 4]);
    }
  }
  void ends() {
    for (const float z : {-kHalfLength, kHalfLength}) {
      rectangle({-kHalfWidth, 0, z}, {2 * kHalfWidth, 0, 0}, {0, kHeight, 0}, paint[0], 800);
      const float in = z < 0 ? 1.0f : -1.0f;
      add_ring(model, {{0, 170, 0}, {0, 0, 40}, {170, 0, 0}, {0, 420, z + in * 30}}, 3000, paint[17], 0.2f);
      add_ball(model, upright({0, 420, z + in * 40}, {95, 110, 60}), 18000, paint[18], 0.3f, 2.5f);
      for (const float x : {-420.0f, -240.0f, 240.0f, 420.0f})
        add_rounded_box(model, upright({x, 280, z + in * 20}, {60, 200, 25}), 600, paint[19]);
    }
  }
};

void generate(Scene& scene, const LoadOptions& options) {
  constexpr uint64_t kTriangles = 262'267;
  static constexpr Pattern kPatterns[] = {Pattern::Bricks, Pattern::Bricks, Pattern::Planks, Pattern::Panels};
  static constexpr const char* kNames[] = {"bricks", "bricks", "planks", "panels"};
  static constexpr Vec3 kCloth[] = {{0.6f, 0.1f, 0.1f}, {0.1f, 0.3f, 0.5f}, {0.15f, 0.4f, 0.15f}};
  Generator generator(scene, options, kTriangles);
  Hall hall{generator, {}};
  for (uint32_t k = 0; k < 24; ++k) {
    const float tone = 0.5f + 0.035f * float(k % 7);
    const Vec3 stone =
        k < 22 ? Vec3{tone, tone * 0.92f, tone * 0.78f} : Vec3{0.25f, 0.42f, 0.16f};  // or leaves
    const bool cloth = k >= 9 && k < 12;
    const std::string name = fmt::format("{}_{}", cloth ? "cloth" : k < 4 ? kNames[k] : "stone", k);
    const Pattern pattern = cloth ? Pattern::Stripes : k < 4 ? kPatterns[k] : Pattern::Stone;
    hall.paint.push_back(generator.textured(
        name, paint_texture(pattern, cloth ? kCloth[k - 9] : stone, 1024, 1024, k, generator.threads())));
  }
  hall.side_of(-1);
  hall.side_of(1);
  hall.ends();
  for (int k = 0; k < 8; ++k) {  // pots on chains, over the court
    const Vec3 pot{k % 2 ? 120.0f : -120.0f, 330, -1600.0f + 400 * float(k)};
    for (int link = 0; link < 24; ++link)
      add_ring(hall.model,
               {{4, 0, link % 2 ? 4.0f : 0.0f},
                {link % 2 ? 2.0f : 0.0f, 0, 2},
                {0, 14, 0},
                pot + Vec3{0, 30 + 21 * float(link), 0}},
               60, hall.paint[20], 0.3f);
    add_ball(hall.model, upright(pot, {30, 24, 30}), 1500, hall.paint[21], 0.2f, 4);
  }
  for (int k = 0; k < 12; ++k) {  // ropes that hold an awning over the court, from gallery to gallery
    const float z = -1500 + 250 * float(k), side = k % 2 ? 1.0f : -1.0f;
    add_cable(hall.model, {-side * kColumns, 800, z}, {side * kColumns, 870, z + 420}, 60, 3, 48,
              hall.paint[20]);
  }
  const uint64_t made = hall.model.indices.size() / 3;
  hall.rectangle({-kHalfWidth, 0, kHalfLength}, {2 * kHalfWidth, 0, 0}, {0, 0, -2 * kHalfLength},
                 hall.paint[3], made + 2000 < kTriangles ? kTriangles - made : 2000);
  generator.model("hall", [&](Model& model) {
    model = std::move(hall.model);
    model.name = "hall";
  });
  scene.note =
      "The scene is a procedural hall with the original's size, triangle count (262,267) and number of "
      "textures (24 of 4 MiB).";
}

}  // namespace

Scene build_sponza(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "SPNZA";
  scene.camera = {.eye = {0, 115, 2}, .target = {0, 115, 1}, .field_of_view = 70, .focus_distance = 2};
  original.empty() ? generate(scene, options) : load(scene, original, options.threads);
  return scene;
}

}  // namespace glint::scenes
