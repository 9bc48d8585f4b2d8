// Writes a picture of the reference renderer: render_reference SCENE pt|sh|ao SIZE SAMPLES OUT.png [ASSETS].
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <map>

#include "base/diagnostics.h"
#include "tests/reference/reference.h"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace {

using glint::scenes::Workload;

int run(char** argv) {
  const std::map<std::string, Workload> workloads = {
      {"pt", Workload::PathTracing}, {"sh", Workload::Shadow}, {"ao", Workload::AmbientOcclusion}};
  const auto workload = workloads.find(argv[2]);
  if (workload == workloads.end())
    throw glint::UserError(fmt::format("unknown workload '{}': pt, sh or ao", argv[2]));
  glint::scenes::RenderParams params;
  params.width = params.height = uint32_t(std::atoi(argv[3]));
  params.samples = uint32_t(std::atoi(argv[4]));
  const glint::scenes::Scene scene = glint::scenes::load_scene(argv[1], {argv[6] ? argv[6] : ""});
  const auto intersector = glint::reference::make_exact_intersector(scene);
  const auto result = glint::reference::render(scene, workload->second, params, *intersector);
  std::vector<unsigned char> bytes;
  for (const auto& color : result.picture)
    for (const float channel : {color.x, color.y, color.z})
      bytes.push_back(static_cast<unsigned char>(std::clamp(channel, 0.0f, 1.0f) * 255.0f + 0.5f));
  const int side = int(params.width);
  if (!stbi_write_png(argv[5], side, side, 3, bytes.data(), 3 * side))
    throw glint::UserError(fmt::format("cannot write '{}'", argv[5]));
  fmt::print("{} ({}): {} triangles, {} spheres, {} rays, hash {:016x}\n", scene.name, scene.form,
             scene.triangles(), scene.procedurals(), result.rays, scene.hash());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6 && argc != 7) {
    fmt::print(stderr, "usage: render_reference SCENE pt|sh|ao SIZE SAMPLES OUT.png [ASSETS]\n");
    return 2;
  }
  try {
    return run(argv);
  } catch (const glint::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return int(error.exit());
  }
}
