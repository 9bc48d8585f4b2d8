// Reads files of camera paths.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/camera_path.h"

#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <optional>

#include "base/diagnostics.h"
#include "pipeline/description/value.h"
#include "scenes/overrides.h"

namespace glint::pipeline {
namespace {

constexpr double kMost = 1e9;  // of a coordinate and of a time; more leaves what floats can square

class PathReader {
 public:
  PathReader(const Value& file, const scenes::Camera& camera) : file_(file), camera_(camera) {}

  scenes::CameraPath read() {
    TableReader t(file_, "a camera path", errors_);
    out_.smooth = t.name("interpolation", "smooth", {"smooth", "linear"}) == "smooth";
    for (const Value* each : t.tables("key")) read_key(*each);
    if (out_.keys.size() < 2)
      errors_.error(
          t.where(),
          fmt::format("a camera path needs two keys or more, and this one has {}", out_.keys.size()),
          "a [[key]] has time, eye and target");
    t.finish();
    errors_.throw_if_errors();
    return std::move(out_);
  }

 private:
  void read_key(const Value& value) {
    TableReader t(value, "a key of a camera path", errors_);
    scenes::PathKey key;
    const std::optional<double> time = number(t, "time", 0, kMost);
    if (time && !out_.keys.empty() && !(*time > out_.keys.back().seconds))
      errors_.error(
          value.where,
          fmt::format("the key is at {} s, and the one before it at {} s", *time, out_.keys.back().seconds),
          "times rise from key to key");
    key.seconds = time.value_or(0);
    key.eye = vector(t, "eye", std::nullopt), key.target = vector(t, "target", std::nullopt);
    key.up = vector(t, "up", camera_.up);
    key.field_of_view = camera_.field_of_view;
    if (t.take("fov")) key.field_of_view = float(number(t, "fov", 0, 180).value_or(key.field_of_view));
    t.finish();
    if (!(key.field_of_view > 0 && key.field_of_view < 180))
      errors_.error(value.where, "'fov' is in degrees, above 0 and below 180");
    else if (!errors_.has_errors())
      check(key, value.where);
    out_.keys.push_back(key);
  }

  void check(const scenes::PathKey& key, const SourceLocation& where) {
    scenes::Camera camera = camera_;
    camera.eye = key.eye, camera.target = key.target, camera.up = key.up;
    camera.field_of_view = key.field_of_view;
    if (const std::string why = scenes::why_blind(camera); !why.empty()) errors_.error(where, why);
  }

  std::optional<double> number(TableReader& t, const std::string& key, double least, double most) {
    const Value* const value = t.take(key);
    if (value && value->is_number() && value->real >= least && value->real <= most) return value->real;
    errors_.error(value ? value->where : t.where(),
                  fmt::format("'{}' is a number from {} to {}", key, least, most));
    return std::nullopt;
  }

  scenes::Vec3 vector(TableReader& t, const std::string& key, std::optional<scenes::Vec3> fallback) {
    const Value* const value = t.take(key);
    if (!value && fallback) return *fallback;
    scenes::Vec3 out{};
    bool is_vector = value && value->kind == Value::Kind::List && value->list.size() == 3;
    for (size_t i = 0; i < 3 && is_vector; ++i) {
      is_vector = value->list[i].is_number() && std::abs(value->list[i].real) <= kMost;
      out[i] = float(value->list[i].real);
    }
    if (!is_vector)
      errors_.error(value ? value->where : t.where(),
                    fmt::format("'{}' is a list of three numbers, x, y and z in world units", key));
    return out;
  }

  const Value& file_;
  const scenes::Camera& camera_;
  Diagnostics errors_;
  scenes::CameraPath out_;
};

}  // namespace

scenes::CameraPath read_camera_path(const std::string& path, const scenes::Camera& camera) {
  return PathReader(read_toml(path), camera).read();
}

}  // namespace glint::pipeline
