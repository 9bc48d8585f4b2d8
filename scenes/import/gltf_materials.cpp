// Reads materials and textures of a glTF file.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/gltf_materials.h"

#include <cstdint>
#include <fmt/format.h>
#include <map>
#include <string>
#include <tiny_gltf.h>
#include <tuple>
#include <utility>

#include "base/diagnostics.h"
#include "scenes/import/gltf_names.h"
#include "scenes/lumibench/builders.h"

namespace glint::scenes {
namespace {

using Pixels = std::vector<unsigned char>;

// Returns a number of an extension's object, or `otherwise` when the file does not give it.
double number_of(const tinygltf::Material& m, const char* extension, const char* name, double otherwise) {
  const auto found = m.extensions.find(extension);
  if (found == m.extensions.end() || !found->second.IsObject() || !found->second.Has(name)) return otherwise;
  return found->second.Get(name).GetNumberAsDouble();
}

class MaterialReader {
 public:
  MaterialReader(Scene& scene, const tinygltf::Model& file, const std::string& path)
      : scene_(scene), file_(file), path_(path) {}

  Material read(const tinygltf::Material& m) {
    const tinygltf::PbrMetallicRoughness& pbr = m.pbrMetallicRoughness;
    const auto& c = pbr.baseColorFactor;
    const Vec3 color = c.size() == 4 ? Vec3{float(c[0]), float(c[1]), float(c[2])} : Vec3{1, 1, 1};
    const auto& e = m.emissiveFactor;
    const auto strength = float(number_of(m, "KHR_materials_emissive_strength", "emissiveStrength", 1));
    // Model: an emissive texture counts as if it were white.
    if (e.size() == 3 && e[0] + e[1] + e[2] > 0)
      return diffuse_light(float(e[0]) * strength, float(e[1]) * strength, float(e[2]) * strength);
    // The extension's default index of refraction is 1.5.
    if (number_of(m, "KHR_materials_transmission", "transmissionFactor", 0) > 0.5)
      return dielectric(float(number_of(m, "KHR_materials_ior", "ior", 1.5)));
    const auto [metal, roughness] = metal_and_roughness(pbr);
    // Model: a surface is all metal or not metal at all, and a metal's lobe is a ball whose radius is its
    // roughness.
    Material out = metal > 0.5 ? metallic(color[0], color[1], color[2], float(roughness))
                               : lambertian(color[0], color[1], color[2]);
    if (pbr.baseColorTexture.index >= 0) out.texture = texture(pbr.baseColorTexture.index, m);
    return out;
  }

 private:
  // Model: a map of metal and roughness is replaced by its mean.
  std::pair<double, double> metal_and_roughness(const tinygltf::PbrMetallicRoughness& pbr) const {
    double metal = pbr.metallicFactor, roughness = pbr.roughnessFactor;
    if (pbr.metallicRoughnessTexture.index < 0) return {metal, roughness};
    const Pixels& texels =
        image_of(named(file_.textures, pbr.metallicRoughnessTexture.index, "texture", path_)).image;
    double green = 0, blue = 0;
    for (size_t i = 0; i + 3 < texels.size(); i += 4) green += texels[i + 1], blue += texels[i + 2];
    const double scale = 4.0 / 255 / double(std::max<size_t>(texels.size(), 4));
    return {metal * blue * scale, roughness * green * scale};
  }

  const tinygltf::Image& image_of(const tinygltf::Texture& texture) const {
    const tinygltf::Image& image = named(file_.images, texture.source, "image", path_);
    const std::string name = name_of(image.uri.empty() ? image.name : image.uri, texture.source);
    // The library goes on where it finds no file, and leaves the picture empty.
    if (image.image.empty())
      throw UserError({path_}, fmt::format("the picture of image {} cannot be read", name),
                      "put the file where the glTF file names it, or export with embedded pictures");
    return image;
  }

  // Choice: blending becomes a mask of one half, because the shaders know only hits and misses.
  int32_t texture(int index, const tinygltf::Material& m) {
    const double cutoff = m.alphaMode == "MASK" ? m.alphaCutoff : m.alphaMode == "BLEND" ? 0.5 : -1;
    const auto& c = m.pbrMetallicRoughness.baseColorFactor;
    const double factor = c.size() == 4 ? c[3] : 1;
    const auto [place, is_new] = known_.try_emplace({index, cutoff, factor}, int32_t(scene_.textures.size()));
    if (!is_new) return place->second;
    const tinygltf::Texture& source = named(file_.textures, index, "texture", path_);
    const tinygltf::Image& image = image_of(source);
    Texture out{.name = image.name.empty() ? image.uri : image.name,
                .width = uint32_t(image.width),
                .height = uint32_t(image.height),
                .rgba = image.image};
    out.srgb = true;  // glTF 2.0, 3.9.2: base colours are sRGB
    // Model: mirrored repetition becomes plain repetition.
    out.repeat = source.sampler < 0 || named(file_.samplers, source.sampler, "sampler", path_).wrapS !=
                                           TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    for (size_t i = 3; i < out.rgba.size(); i += 4) {
      const bool hidden = double(out.rgba[i]) * factor < cutoff * 255;
      scene_.alpha_test |= hidden;
      out.rgba[i] = hidden ? 0 : 255;
    }
    scene_.textures.push_back(std::move(out));
    return place->second;
  }

  Scene& scene_;
  const tinygltf::Model& file_;
  const std::string& path_;
  // Maps texture, cutoff and alpha factor to the index in the scene.
  std::map<std::tuple<int, double, double>, int32_t> known_;
};

}  // namespace

std::vector<int32_t> add_gltf_materials(Scene& scene, const tinygltf::Model& file, const std::string& path) {
  MaterialReader reader(scene, file, path);
  std::vector<int32_t> indices;
  for (const tinygltf::Material& m : file.materials)
    indices.push_back(add_material(scene, m.name, reader.read(m)));
  // Choice: a mesh without a material is grey, as in OBJ files without a library; glTF's default is white.
  indices.push_back(add_material(scene, "", lambertian(0.7f, 0.7f, 0.7f)));
  return indices;
}

}  // namespace glint::scenes
