// Declares the options of a sequence of frames.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/sequence_options.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/diagnostics.h"

namespace glint::app {
namespace {

constexpr uint64_t kLastFrame = 99'999;
// A frame may be this late: times in files are floats, and the last key of an animation may be a little
// early.
constexpr double kLate = 1e-3;  // seconds

constexpr std::array<std::pair<std::string_view, pipeline::StructureUpdate>, 3> kUpdates{
    {{"rebuild", pipeline::StructureUpdate::Rebuild},
     {"refit", pipeline::StructureUpdate::Refit},
     {"refit-bottom", pipeline::StructureUpdate::RefitBottom}}};

std::optional<uint64_t> frame_in(std::string_view text) {
  uint64_t out = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size() || out > kLastFrame) return {};
  return out;
}

}  // namespace

std::string SequenceOptions::given() const {
  const SequenceOptions none;
  return fps != none.fps                 ? "--fps"
         : !camera_path.empty()          ? "--camera-path"
         : !animation.empty()            ? "--animation"
         : structures != none.structures ? "--structures"
                                         : "";
}

void check_without_frames(const SequenceOptions& options) {
  constexpr const char* kNote = "--frames A:B says which frames";
  if (const std::string option = options.given(); !option.empty())
    throw UserError({}, option + " belongs to a sequence of frames", kNote);
  if (!options.caches.empty()) throw UserError({}, kCachesElsewhere, kNote);
}

void add_sequence_options(Command command, SequenceOptions& options) {
  command
      .add_option(
          "--frames", options.frames,
          "Render these frames of a scene that moves, first and last, such as 0:23; frame N is at N / "
          "--fps seconds (docs/animation.md)")
      .type_name("A:B");
  command.add_option("--fps", options.fps, "[1/s] Frames a second")
      .number_range(0.001, 1000)
      .capture_default_str();
  command
      .add_option("--camera-path", options.camera_path,
                  "TOML file with places of the camera at times, for --frames")
      .type_name("FILE");
  command
      .add_option("--animation", options.animation,
                  "Animation of a glTF file to play, for --frames (default: the first one)")
      .type_name("NAME");
  command
      .add_option(
          "--structures", options.structures,
          "Selects what becomes of acceleration structures from frame to frame: rebuild builds those in "
          "which something has moved, refit fits the boxes of their trees, and refit-bottom fits bottom "
          "levels and builds the top level")
      .one_of({"rebuild", "refit", "refit-bottom"})
      .capture_default_str();
}

report::SequenceInfo sequence_of(const SequenceOptions& options) {
  report::SequenceInfo out;
  const std::string_view text = options.frames;
  const size_t colon = text.find(':');
  const auto first = frame_in(text.substr(0, colon)),
             last = colon == std::string_view::npos ? first : frame_in(text.substr(colon + 1));
  if (!first || !last || *first > *last)
    throw UserError({},
                    fmt::format("--frames is '{}', expected the first and the last frame", options.frames),
                    fmt::format("for example 0:23; frames count from 0 to {}", kLastFrame));
  out.first = *first, out.last = *last;
  out.fps = options.fps;
  out.structures = options.structures;
  out.caches = options.caches.empty() ? "warm" : options.caches;
  out.camera_path = options.camera_path;
  out.animation = options.animation;
  return out;
}

pipeline::StructureUpdate structure_update(const SequenceOptions& options) {
  for (const auto& [name, update] : kUpdates)
    if (name == options.structures) return update;
  return pipeline::StructureUpdate::Rebuild;
}

void check_range(const report::SequenceInfo& sequence, const scenes::Motion& motion,
                 const std::string& scene) {
  if (sequence.seconds_of(sequence.last) <= motion.seconds() + kLate) return;
  throw UserError({},
                  fmt::format("frame {} is at {:.6g} s, and the motion of {} ends at {:.6g} s", sequence.last,
                              sequence.seconds_of(sequence.last), scene, motion.seconds()),
                  fmt::format("at {:.6g} frames a second it has the frames 0:{}", sequence.fps,
                              std::floor((motion.seconds() + kLate) * sequence.fps)));
}

}  // namespace glint::app
