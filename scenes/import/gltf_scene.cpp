// Reads a glTF file's nodes as instances, with its camera and lamp.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <tiny_gltf.h>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/lookup.h"
#include "base/parallel_ranges.h"
#include "base/regular_file.h"
#include "pictures/decode.h"
#include "scenes/import/gltf_animation.h"
#include "scenes/import/gltf_materials.h"
#include "scenes/import/gltf_mesh.h"
#include "scenes/import/gltf_motion.h"
#include "scenes/import/gltf_names.h"
#include "scenes/import/scene_file.h"
#include "scenes/lumibench/builders.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

using Matrix = glm::dmat4;  // column-major, as in glTF

// Lists extensions without which the picture is still usable. Files that require another extension are
// refused.
constexpr std::array<std::string_view, 7> kKnownExtensions{
    "KHR_lights_punctual", "KHR_materials_transmission",
    "KHR_materials_ior",   "KHR_materials_emissive_strength",
    "KHR_materials_unlit", "KHR_materials_specular",
    "KHR_materials_volume"};

// Says whether rays can be taken into the space of an instance. The builder of structures inverts in floats.
bool can_be_inverted(const Matrix& m) {
  const Affine to_world = affine_of(m);
  const glm::mat3 to_mesh = glm::inverse(glm::mat3(glm::mat4(m)));
  const auto is_finite = [](const auto& column) {
    return !glm::any(glm::isnan(column) || glm::isinf(column));
  };
  bool all = true;
  for (size_t i = 0; i < 3; ++i) all = all && is_finite(to_world[i]) && is_finite(to_mesh[i]);
  return all;
}

class Nodes {
 public:
  Nodes(Scene& scene, const tinygltf::Model& file, const std::string& path, const LoadOptions& options)
      : scene_(scene),
        file_(file),
        path_(path),
        options_(options),
        materials_(add_gltf_materials(scene, file, path)),
        has_parent_(file.nodes.size()) {}

  // Adds a node and those below it. The nodes of a file are trees (glTF 2.0, 3.5.2), so none comes twice.
  void add(int root) {
    std::vector<std::pair<int, Matrix>> open{{root, Matrix(1)}};
    while (!open.empty()) {
      const auto [index, above] = open.back();
      open.pop_back();
      const tinygltf::Node& node = named(file_.nodes, index, "node", path_);
      if (has_parent_[size_t(index)])
        fail(node, index, "it has two parents or stands below itself, and nodes form trees");
      has_parent_[size_t(index)] = true;
      const Matrix matrix = above * pose_of(node).local();
      add_content(node, index, matrix);
      // The last child is put first, so that nodes come in the order of the file.
      for (size_t i = node.children.size(); i-- > 0;) open.emplace_back(node.children[i], matrix);
    }
  }

  // Removes instances without triangles, which nothing could name, and adds the lamp and the sky.
  void finish() {
    std::erase_if(scene_.instances,
                  [&](const Instance& i) { return scene_.models[i.model].indices.empty(); });
    if (scene_.instances.empty()) throw UserError({path_}, "its scene has no triangles");
    add_lamp();
    const auto glows = [&](const Material& m) { return m.model == MaterialModel::DiffuseLight; };
    scene_.camera.has_sky = std::none_of(scene_.materials.begin(), scene_.materials.end(), glows);
  }

  // Returns what moves, once the scene is finished.
  GltfMoving take_moving() { return std::move(moving_); }

 private:
  // The lamp's radius is this share of the scene's extent. Choice: the lamp is large, because paths find it
  // only by chance.
  static constexpr float kLampSize = 0.05f;
  static constexpr float kLampColor = 15;  // like the lamps of LumiBench's scenes
  static constexpr int kStands = -1;       // instead of the node of an instance

  [[noreturn]] void fail(const tinygltf::Node& node, int index, const std::string& what) const {
    throw UserError({path_}, fmt::format("node {}: {}", name_of(node.name, index), what));
  }

  void add_content(const tinygltf::Node& node, int index, const Matrix& matrix) {
    if (node.mesh >= 0 && options_.moving) {
      add_moving(node, index, matrix);
    } else if (node.mesh >= 0) {
      if (!can_be_inverted(matrix))
        fail(node, index, "its transform flattens its mesh or is not finite, and a ray cannot follow it");
      const uint32_t model = model_of(node.mesh);
      const Bounds box = moved(boxes_[model], affine_of(matrix));
      const glm::vec3 size = box.upper - box.lower;
      if (glm::any(glm::isinf(size)) || glm::any(glm::isnan(size)))
        fail(node, index, "its transform moves its mesh to infinity, and no ray can meet it");
      scene_.instances.push_back({model, affine_of(matrix)});
    }
    if (node.camera >= 0 && !has_camera_) {
      camera(named(file_.cameras, node.camera, "camera", path_), matrix);
      if (has_camera_) moving_.camera_node = index;
    }
    if (const auto light = node.extensions.find("KHR_lights_punctual");
        light != node.extensions.end() && light->second.Has("light"))
      lamp(named(file_.lights, light->second.Get("light").GetNumberAsInt(), "light", path_), index, matrix);
  }

  // Adds the mesh of a node that may move, wherever it is at first: a place that no ray can reach may be
  // left.
  void add_moving(const tinygltf::Node& node, int index, const Matrix& matrix) {
    if (!is_deformed(file_, index)) {
      add_instance(model_of(node.mesh), index, affine_of(matrix));
      return;
    }
    std::vector<PrimitiveOrigin> origins;
    const auto model = uint32_t(scene_.models.size());
    scene_.models.push_back(read_mesh(file_, node.mesh, {materials_, path_, options_.threads}, &origins));
    boxes_.push_back(bounds(scene_.models.back()));
    moving_.deformed.push_back({model, index, {file_, path_, index, origins, scene_.models.back()}});
    add_instance(model, node.skin >= 0 ? kStands : index, node.skin >= 0 ? kIdentity : affine_of(matrix));
  }

  void add_instance(uint32_t model, int node, const Affine& to_world) {
    if (scene_.models[model].indices.empty()) return;
    scene_.instances.push_back({model, to_world});
    moving_.instance_nodes.push_back(node);
  }

  uint32_t model_of(int mesh) {
    const auto [place, is_new] = models_.try_emplace(mesh, uint32_t(scene_.models.size()));
    if (is_new) {
      scene_.models.push_back(read_mesh(file_, mesh, {materials_, path_, options_.threads}));
      boxes_.push_back(bounds(scene_.models.back()));
      if (options_.progress) options_.progress(double(models_.size()) / double(file_.meshes.size()));
    }
    return place->second;
  }

  void camera(const tinygltf::Camera& source, const Matrix& m) {
    if (source.type != "perspective") return;
    has_camera_ = true;
    Camera& out = scene_.camera;
    stand_at(out, m);
    out.field_of_view = float(source.perspective.yfov * 180 / M_PI);
  }

  // Model: a point or spot light becomes a glowing ball that is the same in all directions. A directional
  // light is left to the sky.
  void lamp(const tinygltf::Light& light, int node, const Matrix& m) {
    if (has_lamp_ || light.type == "directional") return;
    has_lamp_ = true;
    moving_.lamp_node = node;
    scene_.camera.light_position = Vec3(m[3]);
  }

  void add_lamp() {
    if (!has_lamp_) return;
    const float radius = std::max(kLampSize * extent(), 1e-6f);
    const int32_t material = add_material(scene_, "", diffuse_light(kLampColor, kLampColor, kLampColor));
    moving_.lamp_model = uint32_t(scene_.models.size());
    moving_.instance_nodes.push_back(kStands);
    scene_.instances.push_back({moving_.lamp_model, kIdentity});
    scene_.models.push_back(make_sphere("lamp", scene_.camera.light_position, radius, material));
    scene_.camera.light_radius = radius;
  }

  float extent() const {
    const Bounds box = world_bounds(scene_);
    return length(box.upper - box.lower);
  }

  Scene& scene_;
  const tinygltf::Model& file_;
  const std::string& path_;
  const LoadOptions& options_;
  const std::vector<int32_t> materials_;
  std::vector<bool> has_parent_;  // of each node: whether it was added
  std::map<int, uint32_t> models_;
  std::vector<Bounds> boxes_;  // of models
  GltfMoving moving_;
  bool has_camera_ = false, has_lamp_ = false;
};

// Keeps the bytes of a picture, which decode_images() reads when all are there.
bool keep_bytes(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                int size, void*) {
  image->image.assign(bytes, bytes + size);
  return true;
}

// Puts texels in the place of the bytes that keep_bytes() has kept.
void decode_images(std::vector<tinygltf::Image>& images, const std::string& path, uint32_t threads) {
  parallel_ranges(images.size(), 1, threads, [&](size_t i, size_t) {
    tinygltf::Image& image = images[i];
    if (image.image.empty()) return;  // The file names no picture here.
    pictures::DecodedPicture picture = pictures::decode_picture(image.image);
    if (!picture.error.empty())
      throw UserError(
          {path}, fmt::format("this file cannot be read: image {} ('{}') is no PNG or JPEG picture: {}", i,
                              image.uri.empty() ? image.name : image.uri, picture.error));
    image.width = int(picture.width), image.height = int(picture.height);
    image.component = 4, image.bits = 8;
    image.image = std::move(picture.bytes);
  });
}

std::string note_of(const tinygltf::Model& file, bool moving) {
  std::string note = "The scene is from a glTF file.";
  if (!moving && (!file.skins.empty() || !file.animations.empty()))
    note += " Skins and animations are not read.";
  const auto blends = [](const tinygltf::Material& m) { return m.alphaMode == "BLEND"; };
  if (std::any_of(file.materials.begin(), file.materials.end(), blends))
    note += " Blending is replaced by a mask of one half.";
  return note;
}

// Notes that the library looks for a file. `log` is what it got for its functions.
void note(void* log, const std::string& path) {
  if (log) static_cast<LookupLog*>(log)->add(path);
}

bool read_whole_file(std::vector<unsigned char>* bytes, std::string* error, const std::string& path,
                     void* log) {
  note(log, path);
  std::optional<std::vector<unsigned char>> read = read_regular_bytes(path);
  if (!read) {
    *error += path + " is no file that can be read";
    return false;
  }
  *bytes = std::move(*read);
  return true;
}

bool is_regular_file(const std::string& path, void* log) {
  note(log, path);
  std::error_code failed;
  return std::filesystem::is_regular_file(path, failed);
}

tinygltf::Model read_file(const std::string& path, uint32_t threads, LookupLog* log) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_bytes, nullptr);
  // The library's own functions wait for the writer when a file names a pipe.
  loader.SetFsCallbacks(
      {is_regular_file, tinygltf::ExpandFilePath, read_whole_file, tinygltf::WriteWholeFile, log});
  tinygltf::Model file;
  std::string error, warning;
  bool good = false;
  try {
    good = path.ends_with(".glb") ? loader.LoadBinaryFromFile(&file, &error, &warning, path)
                                  : loader.LoadASCIIFromFile(&file, &error, &warning, path);
  } catch (const std::out_of_range&) {
    error = "it is damaged";  // The library looks up elements that a damaged file does not have.
  }
  if (!good)
    throw UserError(
        {path}, fmt::format("this file cannot be read: {}", error.empty() ? "it is not glTF 2.0" : error));
  for (const std::string& name : file.extensionsRequired)
    if (std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) == kKnownExtensions.end())
      throw UserError({path}, fmt::format("it requires the extension {}, which is not read", name),
                      "export it without compression or quantisation");
  decode_images(file.images, path, threads);
  return file;
}

}  // namespace

Scene load_gltf(const std::string& path, const LoadOptions& options) {
  const tinygltf::Model file = read_file(path, options.threads, options.log);
  Scene scene;
  Nodes nodes(scene, file, path, options);
  const int number = std::max(0, file.defaultScene);
  for (const int node : named(file.scenes, number, "scene", path).nodes) nodes.add(node);
  nodes.finish();
  scene.note = note_of(file, options.moving);
  if (options.moving) {
    scene.motion = gltf_motion(file, path, number, options.animation, nodes.take_moving());
    scene.motion->pose(scene, 0);
    if (scene.motion->seconds() == 0) scene.motion.reset();  // The file has no animation.
  }
  return scene;
}

}  // namespace glint::scenes
