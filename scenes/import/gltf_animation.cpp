// Reads and evaluates glTF animations.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/gltf_animation.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>
#include <tiny_gltf.h>
#include <utility>

#include "base/diagnostics.h"
#include "scenes/import/gltf_accessor.h"
#include "scenes/import/gltf_names.h"

namespace glint::scenes {
namespace {

glm::dquat quaternion(const double* xyzw) {
  return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
}

// Returns the number of the animation that is meant.
size_t number_of(const tinygltf::Model& file, const std::string& path, const std::string& name) {
  if (name.empty()) return 0;
  std::vector<std::string> names;
  for (size_t i = 0; i < file.animations.size(); ++i) {
    if (file.animations[i].name == name) return i;
    names.push_back(name_of(file.animations[i].name, int(i)));
  }
  size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error == std::errc{} && end == name.data() + name.size() && number < file.animations.size())
    return number;
  throw UserError({path}, fmt::format("it has no animation '{}'", name),
                  names.empty() ? "it has no animations at all"
                                : fmt::format("its animations are {}", fmt::join(names, ", ")));
}

}  // namespace

glm::dmat4 NodePose::local() const {
  if (matrix) return *matrix;
  glm::dmat4 out = glm::mat4_cast(rotation);
  for (size_t c = 0; c < 3; ++c) out[c] *= scale[c];
  out[3] = glm::dvec4(translation, 1);
  return out;
}

NodePose pose_of(const tinygltf::Node& node) {
  NodePose out;
  if (node.matrix.size() == 16) out.matrix = glm::make_mat4(node.matrix.data());
  if (node.rotation.size() == 4) out.rotation = quaternion(node.rotation.data());
  if (node.scale.size() == 3) out.scale = glm::make_vec3(node.scale.data());
  if (node.translation.size() == 3) out.translation = glm::make_vec3(node.translation.data());
  out.weights = node.weights;
  return out;
}

GltfAnimation::GltfAnimation(const tinygltf::Model& file, const std::string& path, const std::string& name)
    : moves_(file.nodes.size()) {
  const size_t animation = number_of(file, path, name);
  if (file.animations.empty()) return;
  for (size_t i = 0; i < file.animations[animation].channels.size(); ++i)
    add_channel(file, path, animation, i);
}

void GltfAnimation::add_channel(const tinygltf::Model& file, const std::string& path, size_t animation,
                                size_t number) {
  const tinygltf::Animation& source = file.animations[animation];
  const tinygltf::AnimationChannel& from = source.channels[number];
  const GltfPlace place{file, path, "animation " + name_of(source.name, int(animation))};
  if (from.target_node < 0) return;  // It is for an extension that is not read (glTF 2.0, 3.11).
  const tinygltf::Node& node = named(file.nodes, from.target_node, "node", path);
  Channel channel;
  channel.node = from.target_node;
  if (from.target_path == "translation" || from.target_path == "scale")
    channel.path = from.target_path == "scale" ? Path::Scale : Path::Translation, channel.components = 3;
  else if (from.target_path == "rotation")
    channel.path = Path::Rotation, channel.components = 4;
  else if (from.target_path == "weights")
    channel.path = Path::Weights, channel.components = 1;
  else
    return;  // It is an extension's, too.
  if (channel.path != Path::Weights && node.matrix.size() == 16)
    place.fail(fmt::format("it moves node {}, which has a matrix", name_of(node.name, from.target_node)));
  const tinygltf::AnimationSampler& sampler = named(source.samplers, from.sampler, "sampler", path);
  channel.times = floats_of(place, sampler.input, 1, "the times of a sampler");
  channel.values = floats_of(place, sampler.output, int(channel.components), "the values of a sampler");
  if (sampler.interpolation == "STEP") channel.interpolation = Interpolation::Step;
  if (sampler.interpolation == "CUBICSPLINE") channel.interpolation = Interpolation::CubicSpline;
  if (channel.times.empty()) place.fail("a sampler has no keys");
  for (size_t i = 0; i < channel.times.size(); ++i)
    if (!std::isfinite(channel.times[i]) || channel.times[i] < 0 ||
        (i > 0 && !(channel.times[i] > channel.times[i - 1])))
      place.fail(fmt::format("the times of a sampler do not rise: key {} is at {} s", i, channel.times[i]));
  for (const float value : channel.values)
    if (!std::isfinite(value)) place.fail(fmt::format("a value of a sampler is {}", value));
  const size_t keys = channel.times.size() * (channel.interpolation == Interpolation::CubicSpline ? 3 : 1);
  if (channel.path == Path::Weights) channel.components = channel.values.size() / keys;
  if (channel.components == 0 || channel.values.size() != keys * channel.components)
    place.fail(fmt::format("a sampler has {} values for {} keys", channel.values.size(), keys));
  moves_[size_t(channel.node)] = true;
  seconds_ = std::max(seconds_, double(channel.times.back()));
  channels_.push_back(std::move(channel));
}

// Interpolates as appendix C of glTF 2.0 does.
std::vector<double> GltfAnimation::Channel::at(double seconds) const {
  const bool is_cubic = interpolation == Interpolation::CubicSpline;
  const auto part = [&](size_t key, size_t which) {  // 0: in-tangent, 1: value, 2: out-tangent
    const size_t first = (is_cubic ? 3 * key + which : key) * components;
    return std::vector<double>(values.begin() + ptrdiff_t(first),
                               values.begin() + ptrdiff_t(first + components));
  };
  const size_t next = size_t(std::upper_bound(times.begin(), times.end(), seconds) - times.begin());
  if (next == 0 || next == times.size()) return part(next == 0 ? 0 : times.size() - 1, 1);
  std::vector<double> from = part(next - 1, 1);
  if (interpolation == Interpolation::Step) return from;
  const std::vector<double> to = part(next, 1);
  const double begin = times[next - 1], span = double(times[next]) - begin, t = (seconds - begin) / span;
  if (is_cubic) {
    const std::vector<double> out_tangent = part(next - 1, 2), in_tangent = part(next, 0);
    const double t2 = t * t, t3 = t2 * t;
    for (size_t i = 0; i < components; ++i)
      from[i] = (2 * t3 - 3 * t2 + 1) * from[i] + span * (t3 - 2 * t2 + t) * out_tangent[i] +
                (3 * t2 - 2 * t3) * to[i] + span * (t3 - t2) * in_tangent[i];
    return from;
  }
  if (path == Path::Rotation) {
    const glm::dquat q = glm::slerp(quaternion(from.data()), quaternion(to.data()), t);
    return {q.x, q.y, q.z, q.w};
  }
  for (size_t i = 0; i < components; ++i) from[i] += (to[i] - from[i]) * t;
  return from;
}

void GltfAnimation::pose(std::vector<NodePose>& nodes, double seconds) const {
  for (const Channel& channel : channels_) {
    NodePose& node = nodes[size_t(channel.node)];
    const std::vector<double> value = channel.at(seconds);
    switch (channel.path) {
      case Path::Translation:
        node.translation = glm::make_vec3(value.data());
        break;
      case Path::Rotation:
        node.rotation = glm::normalize(quaternion(value.data()));
        break;
      case Path::Scale:
        node.scale = glm::make_vec3(value.data());
        break;
      case Path::Weights:
        node.weights = value;
        break;
    }
  }
}

}  // namespace glint::scenes
