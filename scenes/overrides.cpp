// Changes the camera, the light and the materials of a scene.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/overrides.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/diagnostics.h"
#include "scenes/camera.h"

namespace glint::scenes {
namespace {

constexpr float kFarthest = 1e9f;  // world units; squares of longer vectors leave the range of a float

// Returns numbers that commas separate. They are empty unless each has the form of a number in the range.
std::vector<float> numbers_in(std::string_view text, float low, float high) {
  std::vector<float> out;
  while (true) {
    float value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || !(value >= low && value <= high)) return {};
    out.push_back(value);
    text.remove_prefix(size_t(end - text.data()));
    if (text.empty()) return out;
    if (text.front() != ',') return {};
    text.remove_prefix(1);
  }
}

constexpr float kBrightest = 1e6f;
constexpr size_t kNamesShown = 8;  // in an error
constexpr const char* kLightForm = "for example --light sky=off, --light position=0,10,0 or --light radius=2";
// No shader implements the model Isotropic.
constexpr MaterialModel kModels[] = {MaterialModel::Lambertian, MaterialModel::Metallic,
                                     MaterialModel::Dielectric, MaterialModel::DiffuseLight};

std::string material_form() {
  std::string out = "the keys are ";
  for (const auto& [key, form] : material_keys()) out += fmt::format("{} ({}); ", key, form);
  return out + "for example --material 0.diffuse=1,0,0";
}

struct CameraKey {
  std::string_view key, option;
  Vec3 Camera::*place;  // null: the field of view
};
constexpr CameraKey kCameraKeys[] = {{"camera.eye", "--eye", &Camera::eye},
                                     {"camera.look-at", "--look-at", &Camera::target},
                                     {"camera.up", "--up", &Camera::up},
                                     {"camera.fov", "--fov", nullptr}};

void override_camera(Camera& camera, const CameraKey& key, const std::string& value) {
  const std::vector<float> numbers = numbers_in(value, -kFarthest, kFarthest);
  if (key.place) {
    if (numbers.size() != 3)
      throw UserError({}, fmt::format("{} is '{}', expected X,Y,Z in world units", key.option, value),
                      fmt::format("for example {} 0,1.5,-4", key.option));
    camera.*key.place = {numbers[0], numbers[1], numbers[2]};
    return;
  }
  if (numbers.size() != 1 || numbers[0] <= 0 || numbers[0] >= 180)
    throw UserError({}, fmt::format("{} is '{}', expected degrees above 0 and below 180", key.option, value),
                    "it is the angle from the lower edge of the picture to the upper one");
  camera.field_of_view = numbers[0];
}

void override_light(Camera& camera, const std::string& key, const std::string& value) {
  if (key == "light.sky") {
    if (value != "on" && value != "off")
      throw UserError({}, fmt::format("--light sky is '{}', expected on or off", value));
    camera.has_sky = value == "on";
  } else if (key == "light.position") {
    const std::vector<float> numbers = numbers_in(value, -kFarthest, kFarthest);
    if (numbers.size() != 3)
      throw UserError({}, fmt::format("--light position is '{}', expected X,Y,Z in world units", value));
    camera.light_position = {numbers[0], numbers[1], numbers[2]};
  } else if (key == "light.radius") {
    const std::vector<float> numbers = numbers_in(value, 0, kFarthest);
    if (numbers.size() != 1)
      throw UserError({}, fmt::format("--light radius is '{}', expected a length in world units", value));
    camera.light_radius = numbers[0];
  } else {
    throw UserError({}, fmt::format("a light has no '{}'", key.substr(key.find('.') + 1)), kLightForm);
  }
}

// Returns the materials of a number or a name, or throws UserError with those that there are.
std::vector<size_t> materials_of(const Scene& scene, const std::string& name) {
  std::vector<size_t> out;
  for (size_t i = 0; i < scene.material_names.size(); ++i)
    if (!name.empty() && scene.material_names[i] == name) out.push_back(i);
  size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (out.empty() && error == std::errc{} && end == name.data() + name.size() &&
      number < scene.materials.size())
    out.push_back(number);
  if (!out.empty()) return out;
  std::string names;
  for (size_t i = 0, shown = 0; i < scene.material_names.size() && shown < kNamesShown; ++i)
    if (!scene.material_names[i].empty())
      names += fmt::format("{}'{}'", shown++ ? ", " : "; some have names: ", scene.material_names[i]);
  throw UserError({},
                  fmt::format("there is no material '{}' in {}; it has the materials 0 to {}{}", name,
                              scene.name, int64_t(scene.materials.size()) - 1, names),
                  fmt::format("'glint list materials {}' lists them", scene.name));
}

// Sets one key of a material. Returns whether the value is of the key's kind.
bool set_material(Material& material, std::string_view key, const std::string& value, size_t textures) {
  if (key == "model") {
    for (const MaterialModel model : kModels)
      if (value == name_of(model)) {
        material.model = model;
        if (model == MaterialModel::Dielectric && material.refraction_index == 0)
          material.refraction_index = 1.5f;  // glass
        return true;
      }
    return false;
  }
  if (key == "diffuse") {
    const std::vector<float> numbers = numbers_in(value, 0, kBrightest);
    for (size_t c = 0; c < 3 && numbers.size() == 3; ++c) material.diffuse[c] = numbers[c];
    return numbers.size() == 3;
  }
  if (key == "texture") {
    if (value == "none") return material.texture = -1, true;
    const std::vector<float> number = numbers_in(value, 0, float(textures) - 1);
    if (number.size() == 1) material.texture = int32_t(number[0]);
    return number.size() == 1 && number[0] == std::floor(number[0]);
  }
  const bool is_fuzziness = key == "fuzziness";
  const std::vector<float> number = is_fuzziness ? numbers_in(value, 0, 1) : numbers_in(value, 1, 100);
  if (number.size() == 1) (is_fuzziness ? material.fuzziness : material.refraction_index) = number[0];
  return number.size() == 1;
}

void override_material(Scene& scene, const std::string& key, const std::string& value) {
  const size_t first = key.find('.') + 1, last = key.rfind('.');
  const std::string name = key.substr(first, last < first ? 0 : last - first), what = key.substr(last + 1);
  for (const auto& [known, form] : material_keys()) {
    if (known != what) continue;
    for (const size_t i : materials_of(scene, name))
      if (!set_material(scene.materials[i], known, value, scene.textures.size()))
        throw UserError({}, fmt::format("--material {}.{} is '{}', expected {}", name, what, value, form));
    return;
  }
  throw UserError({}, fmt::format("a material has no '{}'", what), material_form());
}

}  // namespace

std::string_view name_of(MaterialModel model) {
  switch (model) {
    case MaterialModel::Lambertian:
      return "lambertian";
    case MaterialModel::Metallic:
      return "metallic";
    case MaterialModel::Dielectric:
      return "dielectric";
    case MaterialModel::Isotropic:
      return "isotropic";
    case MaterialModel::DiffuseLight:
      return "light";
  }
  return "unknown";
}

std::vector<std::pair<std::string_view, std::string_view>> material_keys() {
  return {{"diffuse", "R,G,B, each 0 to 1000000; a light emits it"},
          {"model", "lambertian, metallic, dielectric or light"},
          {"fuzziness", "0 to 1, of a metallic material"},
          {"refraction_index", "1 to 100, of a dielectric material"},
          {"texture", "none, or the number of a texture of the scene"}};
}

Override light_override(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw UserError({}, fmt::format("--light is '{}', expected KEY=VALUE", text), kLightForm);
  return {"light." + text.substr(0, equals), text.substr(equals + 1)};
}

Override material_override(const std::string& text) {
  for (const auto& [key, form] : material_keys()) {
    const std::string mark = fmt::format(".{}=", key);
    const size_t at = text.find(mark);
    if (at == std::string::npos || at == 0) continue;
    return {fmt::format("material.{}.{}", text.substr(0, at), key), text.substr(at + mark.size())};
  }
  throw UserError({}, fmt::format("--material is '{}', expected NAME.KEY=VALUE", text), material_form());
}

std::string why_blind(const Camera& camera, std::string* note) {
  const auto text = [](const Vec3& v) { return fmt::format("{},{},{}", v[0], v[1], v[2]); };
  const auto told = [&](std::string why, const char* what_to_do) {
    if (note) *note = what_to_do;
    return why;
  };
  const Vec3 view = camera.target - camera.eye;
  if (glm::dot(view, view) == 0)
    return told(fmt::format("the camera at {} looks at its own place", text(camera.eye)),
                "--eye and --look-at must name two places");
  const Vec3 side = glm::cross(view, camera.up);
  // Directions closer than 1/1000 give a picture whose rotation is chance.
  if (!(glm::dot(side, side) > 1e-6f * glm::dot(view, view) * glm::dot(camera.up, camera.up)))
    return told(fmt::format("the camera looks along {}, which is also its upward direction {}", text(view),
                            text(camera.up)),
                "--up gives another upward direction");
  const CameraMatrices matrices = camera_matrices(camera, 1);
  for (const Mat4& m :
       {matrices.model_view, matrices.projection, matrices.model_view_inverse, matrices.projection_inverse})
    for (size_t c = 0; c < 4; ++c)
      for (size_t r = 0; r < 4; ++r)
        if (!std::isfinite(m[c][r]))
          return told(fmt::format("the camera at {} that looks at {} is out of range", text(camera.eye),
                                  text(camera.target)),
                      "");
  return "";
}

void override_scene(Scene& scene, const std::vector<Override>& overrides) {
  bool is_moved = false, is_lit = false;
  for (const auto& [key, value] : overrides) {
    if (key.starts_with("light.")) {
      is_lit = is_lit || key != "light.sky";
      override_light(scene.camera, key, value);
      continue;
    }
    if (key.starts_with("material.")) {
      override_material(scene, key, value);
      continue;
    }
    const CameraKey* found = nullptr;
    for (const CameraKey& one : kCameraKeys)
      if (one.key == key) found = &one;
    if (!found) throw UserError({}, fmt::format("'{}' is not a part of a scene", key));
    override_camera(scene.camera, *found, value);
    is_moved = true;
  }
  std::string note;
  if (const std::string why = is_moved ? why_blind(scene.camera, &note) : ""; !why.empty())
    throw UserError({}, why, note);
  if (is_lit && scene.camera.has_sky)
    throw UserError({}, fmt::format("{} has a sky, and its light is used only without one", scene.name),
                    "--light sky=off takes the sky away");
}

}  // namespace glint::scenes
