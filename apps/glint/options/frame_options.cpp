// Declares the options of a frame, those of its parameters from their list.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/frame_options.h"

#include <array>
#include <fmt/format.h>

#include "apps/glint/options/image_size.h"

namespace glint::app {
namespace {

// Describes an option that holds one text.
struct TextOption {
  const char *name, *key;  // `key` is that of scenes::Override, or empty
  std::string FrameOptions::*text;
  const char *type, *doc;
};
constexpr std::array kTexts = {
    TextOption{"--crop", "", &FrameOptions::crop, "X,Y,W,H",
               "Render only this window of the frame, with the pixels that the whole frame of --size has "
               "there; X and Y count from the top left"},
    TextOption{"--eye", "camera.eye", &FrameOptions::eye, "X,Y,Z",
               "Place of the camera in world units, instead of the scene's"},
    TextOption{"--look-at", "camera.look-at", &FrameOptions::look_at, "X,Y,Z",
               "Place in the middle of the picture, instead of the scene's"},
    TextOption{"--up", "camera.up", &FrameOptions::up, "X,Y,Z",
               "Direction that is upwards in the picture, instead of the scene's"},
    TextOption{"--fov", "camera.fov", &FrameOptions::fov, "DEGREES",
               "[degree] Vertical field of view, instead of the scene's"}};

}  // namespace

scenes::RenderParams FrameOptions::frame() const {
  scenes::RenderParams out = params;
  parse_size(size, out);
  parse_crop(crop, out);
  return out;
}

std::vector<scenes::Override> FrameOptions::overrides() const {
  std::vector<scenes::Override> out;
  for (const TextOption& option : kTexts)
    if (*option.key && !(this->*option.text).empty()) out.emplace_back(option.key, this->*option.text);
  for (const std::string& text : light) out.push_back(scenes::light_override(text));
  for (const std::string& text : materials) out.push_back(scenes::material_override(text));
  return out;
}

std::string FrameOptions::given() const {
  for (const TextOption& option : kTexts)
    if (!(this->*option.text).empty()) return option.name;
  return !light.empty() ? "--light" : !materials.empty() ? "--material" : "";
}

std::vector<std::string> FrameOptions::arguments() const {
  std::vector<std::string> out = {"--size=" + size};
  for (const TextOption& option : kTexts)
    if (!(this->*option.text).empty()) out.push_back(fmt::format("{}={}", option.name, this->*option.text));
  for (const std::string& text : light) out.push_back("--light=" + text);
  for (const std::string& text : materials) out.push_back("--material=" + text);
  for (const scenes::RenderParam& p : scenes::RenderParams::params())
    if (!p.option.empty()) out.push_back(fmt::format("{}={}", p.option, params.*p.field));
  return out;
}

void add_frame_options(Command command, FrameOptions& options) {
  command.add_option("--size", options.size, "Image size in pixels").type_name("WxH").capture_default_str();
  for (const TextOption& option : kTexts)
    command.add_option(option.name, options.*option.text, option.doc).type_name(option.type);
  command
      .add_option("--light", options.light,
                  "Change the light of the scene: sky=on|off, position=X,Y,Z, radius=LENGTH; repeatable")
      .type_name("KEY=VALUE")
      .allow_extra_args(false);
  command
      .add_option("--material", options.materials,
                  "Change a material of the scene: diffuse=R,G,B, model, fuzziness, refraction_index or "
                  "texture=none; 'glint list materials SCENE' lists numbers and names; repeatable")
      .type_name("NAME.KEY=VALUE")
      .allow_extra_args(false);
  for (const scenes::RenderParam& p : scenes::RenderParams::params()) {
    if (p.option.empty()) continue;
    Option option = command.add_option(std::string(p.option), options.params.*p.field, std::string(p.doc));
    if (p.max != ~0u) option.in_range(p.min, p.max);
    option.capture_default_str();
  }
}

}  // namespace glint::app
