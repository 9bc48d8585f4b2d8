// Reads frame.json.
// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace rt_frames {
namespace {

using Json = nlohmann::json;

template <class Value>
Value one_of(const std::string& word, const std::map<std::string, Value>& known, const std::string& what) {
  const auto found = known.find(word);
  if (found == known.end()) throw std::runtime_error("'" + word + "' is no " + what);
  return found->second;
}

VkShaderStageFlagBits stage_of(const std::string& word) {
  return one_of<VkShaderStageFlagBits>(word,
                                       {{"raygen", VK_SHADER_STAGE_RAYGEN_BIT_KHR},
                                        {"miss", VK_SHADER_STAGE_MISS_BIT_KHR},
                                        {"closest_hit", VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR},
                                        {"any_hit", VK_SHADER_STAGE_ANY_HIT_BIT_KHR},
                                        {"intersection", VK_SHADER_STAGE_INTERSECTION_BIT_KHR},
                                        {"callable", VK_SHADER_STAGE_CALLABLE_BIT_KHR}},
                                       "stage");
}

VkFormat format_of(const std::string& word) {
  return one_of<VkFormat>(word,
                          {{"rgba8_unorm", VK_FORMAT_R8G8B8A8_UNORM},
                           {"rgba8_srgb", VK_FORMAT_R8G8B8A8_SRGB},
                           {"rgba32_float", VK_FORMAT_R32G32B32A32_SFLOAT}},
                          "format of an image");
}

class Reader {
 public:
  explicit Reader(Frame& frame) : frame_(frame) {}

  void read(const Json& json) {
    if (json.at("format") != "glint-frame") throw std::runtime_error("the format is not \"glint-frame\"");
    if (json.at("version") != 1) throw std::runtime_error("this program reads version 1");
    frame_.name = json.at("name");
    frame_.launch = json.at("launch");
    for (const auto& [name, buffer] : json.at("buffers").items())
      frame_.buffers[name] = frame_.folder / buffer.at("file").get<std::string>();
    read_pipeline(json);
    for (const Json& level : json.at("bottom_levels")) {
      std::vector<Geometry>& to = frame_.bottom_levels.emplace_back();
      for (const Json& geometry : level.at("geometries")) to.push_back(geometry_of(geometry));
    }
    frame_.instances = range_of(json.at("instances"));
    for (const Json& binding : json.at("bindings")) frame_.bindings.push_back(binding_of(binding));
    if (json.contains("push_constants")) frame_.push_constants = buffer_of(json.at("push_constants"));
    frame_.picture = json.at("picture");
  }

 private:
  void read_pipeline(const Json& json) {
    for (const Json& shader : json.at("shaders"))
      frame_.shaders.push_back({stage_of(shader.at("stage")),
                                frame_.folder / shader.at("file").get<std::string>(), shader.at("entry")});
    const auto shader_of = [&](const Json& group, const char* key) {
      const uint32_t number = group.value(key, VK_SHADER_UNUSED_KHR);
      if (number != VK_SHADER_UNUSED_KHR && number >= frame_.shaders.size())
        throw std::runtime_error(std::string("a group has no shader of this number as ") + key);
      return number;
    };
    for (const Json& group : json.at("groups"))
      frame_.groups.push_back({shader_of(group, "general"), shader_of(group, "closest_hit"),
                               shader_of(group, "any_hit"), shader_of(group, "intersection")});
    const Json& table = json.at("table");
    frame_.table = {table.at("raygen"), table.at("miss"), table.at("hit"), table.at("callable")};
    for (const auto* list : {&frame_.table.miss, &frame_.table.hit, &frame_.table.callable})
      for (const uint32_t group : *list) check_group(group);
    check_group(frame_.table.raygen);
    frame_.recursion = json.at("recursion");
  }

  void check_group(uint32_t group) const {
    if (group >= frame_.groups.size()) throw std::runtime_error("the table names a group that is not there");
  }

  std::string buffer_of(const Json& json) const {
    const std::string name = json.at("buffer");
    if (!frame_.buffers.count(name)) throw std::runtime_error("there is no buffer '" + name + "'");
    return name;
  }

  Range range_of(const Json& json) const {
    return {buffer_of(json), json.at("offset"), json.value("stride", uint64_t{0}), json.at("count")};
  }

  Geometry geometry_of(const Json& json) const {
    Geometry out;
    if (json.contains("boxes"))
      out.boxes = range_of(json.at("boxes"));
    else
      out.vertices = range_of(json.at("vertices")), out.indices = range_of(json.at("indices"));
    for (const Json& flag : json.at("flags"))
      out.flags |= one_of<VkGeometryFlagsKHR>(
          flag,
          {{"opaque", VK_GEOMETRY_OPAQUE_BIT_KHR},
           {"no_duplicate_any_hit", VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR}},
          "flag of a geometry");
    return out;
  }

  Picture picture_of(const Json& json) const {
    const std::array<uint32_t, 2> size = json.at("size");
    return {json.contains("buffer") ? buffer_of(json) : "", format_of(json.at("format")), size[0], size[1],
            json.value("wrap", "clamp") == "repeat"};
  }

  Binding binding_of(const Json& json) const {
    Binding out;
    out.binding = json.at("binding");
    out.type = one_of<VkDescriptorType>(json.at("kind"),
                                        {{"top_level", VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR},
                                         {"storage_image", VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                                         {"textures", VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
                                         {"uniform_buffer", VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                                         {"storage_buffer", VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
                                        "kind of binding");
    if (out.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) out.pictures.push_back(picture_of(json));
    if (out.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER)
      for (const Json& image : json.at("images")) out.pictures.push_back(picture_of(image));
    if (out.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER || out.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER)
      out.buffer = buffer_of(json);
    return out;
  }

  Frame& frame_;
};

}  // namespace

Frame read_frame(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "frame.json";
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  Frame frame;
  frame.folder = folder;
  try {
    Reader(frame).read(Json::parse(in));
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
  return frame;
}

}  // namespace rt_frames
