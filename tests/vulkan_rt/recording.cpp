// Reads scene.json and the arrays beside it.
// SPDX-License-Identifier: Apache-2.0
#include "tests/vulkan_rt/recording.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <zstd.h>

namespace glint::vulkan_rt {
namespace {

using Json = nlohmann::json;

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string unpacked(const std::string& packed, const std::string& name) {
  std::string out(ZSTD_getFrameContentSize(packed.data(), packed.size()), '\0');
  ZSTD_DCtx* context = ZSTD_createDCtx();
  ZSTD_DCtx_setParameter(context, ZSTD_d_windowLogMax, 27);  // packed with --long=27
  const size_t bytes = ZSTD_decompressDCtx(context, out.data(), out.size(), packed.data(), packed.size());
  ZSTD_freeDCtx(context);
  if (bytes != out.size()) throw std::runtime_error("cannot unpack " + name);
  return out;
}

template <class T>
std::vector<T> array(const std::filesystem::path& path) {
  const bool plain = std::filesystem::exists(path);
  const std::string bytes =
      plain ? bytes_of(path) : unpacked(bytes_of(path.string() + ".zst"), path.string());
  if (bytes.size() % sizeof(T)) throw std::runtime_error(path.string() + " ends within an element");
  std::vector<T> out(bytes.size() / sizeof(T));
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

std::vector<Geometry> bottom(const Json& json) {
  std::vector<Geometry> out;
  for (const Json& g : json.at("geoms")) {
    const bool triangles = g.at("type") == "tri";
    out.push_back({triangles, g.at("opaque") != 0, triangles ? g.at("firstVert").get<uint32_t>() : 0,
                   g.at(triangles ? "tris" : "count").get<uint32_t>()});
  }
  return out;
}

Recording load(const std::filesystem::path& folder) {
  const Json scene = Json::parse(bytes_of(folder / "scene.json"));
  Recording r;
  r.folder = folder;
  for (const Json& v : scene.at("verts")) r.vertices.push_back({v[0], v[1], v[2], 1.0f});
  for (const Json& s : scene.at("spheres")) r.spheres.push_back({s[0], s[1], s[2], s[3]});
  for (const Json& b : scene.at("blas")) r.bottoms.push_back(bottom(b));
  for (const Json& i : scene.at("instances"))
    r.instances.push_back(
        {i.at("blas"), i.at("mask"), i.at("customIndex"), i.at("sbtOffset"), i.at("flags"), i.at("xform")});
  for (const Json& m : scene.at("modes"))
    r.modes.push_back({m.at("name"), m.at("pattern"), m.at("rayFlags"), m.at("mask"), m.at("sbtOffset"),
                       m.at("sbtStride"), m.at("missIndex"), m.at("ahMode"), m.at("callable")});
  r.rays_per_pattern = scene.at("raysPerPattern");
  r.first_launch_index = scene.value("launchIndexOfFirstRay", 0u);
  r.rays = array<Ray>(folder / "rays.bin");
  r.records = array<Record>(folder / "records.bin");
  for (const Mode& m : r.modes)
    if (size_t(m.pattern + 1) * r.rays_per_pattern > r.rays.size())
      throw std::runtime_error("rays.bin lacks rays of mode " + m.name);
  if (r.records.size() != r.modes.size() * r.rays_per_pattern)
    throw std::runtime_error("records.bin does not hold one record a mode and ray");
  const bool has_image =
      std::filesystem::exists(folder / "image.raw") || std::filesystem::exists(folder / "image.raw.zst");
  if (has_image) r.image = array<float>(folder / "image.raw");
  r.image_size = uint32_t(std::lround(std::sqrt(double(r.image.size()) / 4)));
  return r;
}

}  // namespace

std::filesystem::path recording_folder() {
  const char* const given = std::getenv("GLINT_VULKAN_RT_DIR");
  if (given && *given) return given;
  return std::filesystem::path(GLINT_SOURCE_DIR) / "../shared/data/vulkan-rt";
}

bool has_recording() {
  return std::filesystem::exists(recording_folder() / "scene.json");
}

const Recording& recording() {
  static const Recording kRecording = load(recording_folder());
  return kRecording;
}

}  // namespace glint::vulkan_rt
