// Renders frames one after another.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/frames.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/launch_sample.h"
#include "apps/glint/run/recorded_run.h"
#include "base/host_threads.h"
#include "pictures/apng.h"
#include "pictures/exr.h"
#include "pipeline/description/camera_path.h"
#include "pipeline/scene_launch.h"
#include "pipeline/structure_cache.h"
#include "pipeline/structure_stats.h"
#include "report/files/run_directory.h"
#include "scenes/camera_path.h"
#include "setup/recorded_launch.h"

namespace glint::app {
namespace {

constexpr const char* kAnimation = "animation.png";
constexpr const char* kTable = "frames.csv";
constexpr size_t kLinesShown = 8;  // of the summary, about frames

std::string picture_of(uint64_t frame) {
  return fmt::format("image-{:04}.png", frame);
}

// Sets the scene's motion and checks that it has the frames.
void check_motion(const SceneOptions& options, const report::SequenceInfo& sequence, scenes::Scene& scene) {
  const std::string& path = options.sequence.camera_path;
  const FrameOptions& frame = options.frame;
  if (!path.empty() && !(frame.eye + frame.look_at + frame.up + frame.fov).empty())
    throw UserError({}, "--camera-path and --eye, --look-at, --up or --fov both place the camera",
                    "leave out one of them");
  if (!path.empty())
    scene.motion = scenes::with_camera_path(scene.motion, pipeline::read_camera_path(path, scene.camera));
  if (!scene.motion) {
    std::vector<std::string> moving;
    for (const scenes::SceneInfo& info : scenes::scene_list())
      if (info.moves) moving.push_back(info.name);
    throw UserError(
        {}, fmt::format("nothing moves in {}, so it has no frames", scene.name),
        fmt::format("--camera-path moves the camera of any scene; {} and glTF files with animations "
                    "move by themselves",
                    fmt::join(moving, ", ")));
  }
  check_range(sequence, *scene.motion, scene.name);
}

// Renders the frames of a sequence and keeps what each leaves.
class FrameRun {
 public:
  FrameRun(const SceneOptions& options, pipeline::RenderJob& job, const report::RunDirectory& directory,
           const report::RunInfo& info)
      : options_(options), job_(job), directory_(directory), info_(info), device_(job.gpu) {}

  pipeline::RenderResult run(const pipeline::LaunchWatch& watch) {
    watch_with(watch);
    std::optional<pipeline::RenderResult> sum;
    const report::SequenceInfo& sequence = *info_.sequence;
    for (uint64_t frame = sequence.first; frame <= sequence.last; ++frame) {
      add_result(render(frame), sum);
      if (sum->end != pipeline::LaunchEnd::Whole) break;
    }
    return std::move(*sum);
  }

  // Times a sample of the frames and renders the others functionally. Only those that were timed have run
  // directories, are in the sum and stay in `info`. All frames leave their pictures.
  pipeline::RenderResult run_sample(const pipeline::LaunchWatch& watch, LaunchSample& sample,
                                    report::RunInfo& info);

  // Writes the files of the sequence. Returns lines for the summary.
  std::vector<std::string> keep() {
    std::vector<std::string> lines = lines_;
    const double fps = info_.sequence->fps;
    // Fractions of whole numbers are exact; others are told in milliseconds.
    const bool is_whole = fps == std::floor(fps);
    const pictures::FrameTime time{uint16_t(is_whole ? 1 : std::min(std::round(1000 / fps), 65535.0)),
                                   uint16_t(is_whole ? fps : 1000)};
    std::vector<std::string> pngs;
    for (auto& [frame, png] : pngs_) pngs.push_back(std::move(png));
    directory_.write(kAnimation, pictures::apng_bytes(pngs, time));
    directory_.write(kTable, table_);
    lines.push_back("animation  " + directory_.path_of(kAnimation));
    lines.push_back("table      " + directory_.path_of(kTable));
    return lines;
  }

 private:
  void watch_with(const pipeline::LaunchWatch& watch) {
    job_.watch = watch;
    job_.watch.is_bounded = options_.shader_dir.empty();  // Their loops count to numbers of rays.
  }

  // Brings the scene, and what the device sees of it, to a frame.
  pipeline::StructureWork prepare(uint64_t frame) {
    job_.scene.motion->pose(job_.scene, info_.sequence->seconds_of(frame));
    scenes::override_scene(job_.scene, options_.frame.overrides());
    if (const std::string why = scenes::why_blind(job_.scene.camera); !why.empty())
      throw UserError({options_.sequence.camera_path}, fmt::format("in frame {} {}", frame, why));
    if (world_) return world_->advance(job_);
    world_ = std::make_unique<pipeline::SceneWorld>(job_);
    world_->world.on_fault = job_.on_fault;
    return world_->first_work(job_);
  }

  // Calls `launch` with a world that is at the frame, and leaves the run directory of the frame.
  using Launch = std::function<pipeline::RenderResult()>;
  pipeline::RenderResult render(uint64_t frame, const Launch& run) {
    const pipeline::StructureWork work = prepare(frame);
    for (const std::string& note : work.notes) fmt::print(stderr, "warning: frame {}: {}\n", frame, note);
    report::RunDirectory directory(directory_.path_of(report::frame_folder(frame)));
    report::RunInfo info = info_of(frame);
    const std::string title = fmt::format("{}, frame {}", info.scene, frame);
    setup::begin_directory(directory, info, job_.gpu, title);
    const auto launch = [&] {
      pipeline::RenderResult result = run();
      pipeline::add_structure_stats(result, work);
      return result;
    };
    const auto keep_frame = [&](const pipeline::RenderResult& result) { keep(directory, result, info); };
    pipeline::RenderResult result = record_launch(directory, info, launch, keep_frame, job_.prints);
    note(frame, work, result, directory);
    return result;
  }
  pipeline::RenderResult render(uint64_t frame) {
    return render(frame, [&] { return pipeline::launch_scene(device_, *world_, job_, caches()); });
  }
  pipeline::RenderResult survey(uint64_t frame, LaunchSample& sample);

  pipeline::Caches caches() const {
    return info_.sequence->caches == "warm" ? pipeline::Caches::Warm : pipeline::Caches::Cold;
  }

  report::RunInfo info_of(uint64_t frame) const {
    report::RunInfo info = info_;
    info.frames.clear(), info.saved.clear(), info.outputs.clear();
    info.moment = {frame, info_.sequence->seconds_of(frame)};
    info.scene_hash = job_.scene.hash(job_.threads);
    info.structures = structure_info(world_->structures);
    return info;
  }

  void keep(const report::RunDirectory& directory, const pipeline::RenderResult& result,
            report::RunInfo& info) {
    const pictures::ImageView image{result.width, result.height, result.rgba};
    keep_picture(info.moment->frame, image);
    directory.write("image.png", pngs_.at(info.moment->frame));
    directory.write("image.pfm", pictures::pfm_bytes(image, host_threads(job_.threads)));
    if (options_.exr) directory.write("image.exr", pictures::exr_bytes(image));
    note_not_finite("image.pfm", image, result.picture, result, info);
    directory.write_stats(result.statistics(), info.compact);
    write_observation(job_.observe, result, directory);
  }

  void keep_picture(uint64_t frame, const pictures::ImageView& image) {
    std::string& png = pngs_[frame] = pictures::png_bytes(image, host_threads(job_.threads));
    directory_.write(picture_of(frame), png);
  }

  // Adds a frame to the table and to the summary.
  void note(uint64_t frame, const pipeline::StructureWork& work, const pipeline::RenderResult& result,
            const report::RunDirectory& directory) {
    table_ += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", frame, info_.sequence->seconds_of(frame),
                          result.cycles, result.warp_instructions, result.rays.rays, result.rays.nodes,
                          work.bottom.built, work.bottom.refitted, work.top.built, work.top.refitted,
                          work.expected_visits, work.expected_visits_rebuilt);
    const uint64_t number = num_noted_++;
    if (number < kLinesShown)
      lines_.push_back(fmt::format("frame {:<4} {}, {}", frame,
                                   job_.timing
                                       ? fmt::format("{} cycles", result.cycles)
                                       : fmt::format("{} warp instructions", result.warp_instructions),
                                   directory.path()));
    if (number == kLinesShown) lines_.push_back("...");
  }

  const SceneOptions& options_;
  pipeline::RenderJob& job_;
  const report::RunDirectory& directory_;
  const report::RunInfo& info_;
  pipeline::Device device_;
  std::unique_ptr<pipeline::SceneWorld> world_;
  uint64_t num_noted_ = 0;
  std::map<uint64_t, std::string> pngs_;  // by frame
  std::vector<std::string> lines_;
  std::string table_ =
      "frame,seconds,cycles,warp_instructions,rays,nodes,bottom_levels_built,bottom_levels_refitted,"
      "top_levels_built,top_levels_refitted,expected_visits,expected_visits_rebuilt\n";
};

pipeline::RenderResult FrameRun::survey(uint64_t frame, LaunchSample& sample) {
  prepare(frame);
  pipeline::RenderResult result = sample.survey("frame", world_->world, caches(), job_.watch);
  pipeline::read_frame(*world_, job_, result);
  keep_picture(frame, {result.width, result.height, result.rgba});
  return result;
}

pipeline::RenderResult FrameRun::run_sample(const pipeline::LaunchWatch& watch, LaunchSample& sample,
                                            report::RunInfo& info) {
  watch_with(watch);
  const report::SequenceInfo& sequence = *info_.sequence;
  std::optional<pipeline::RenderResult> surveyed, sum;
  for (uint64_t frame = sequence.first; frame <= sequence.last; ++frame) {
    add_result(survey(frame, sample), surveyed);
    if (surveyed->end == pipeline::LaunchEnd::Whole) continue;
    info.frames.clear();
    return std::move(*surveyed);
  }
  sample.choose();
  sample.keep_timed(info.frames);
  world_.reset();         // The second pass begins with new structures, as the first one did,
  job_.prints = nullptr;  // and prints nothing again.
  for (size_t i = 0; !sample.is_complete(); ++i) {
    const uint64_t frame = sequence.first + i;
    pipeline::RenderResult result;
    const auto time = [&] {
      pipeline::RenderResult timed = sample.time(i, world_->world, caches(), job_.watch);
      pipeline::read_frame(*world_, job_, timed);
      return timed;
    };
    if (sample.is_timed(i)) {
      result = render(frame, time);
    } else {
      prepare(frame);
      // A frame needs nothing of another one but what it finds in the L2. Model: of frames that are not
      // timed, the last one before a timed one fills it.
      if (sample.is_timed(i + 1) && caches() == pipeline::Caches::Warm)
        result = sample.warm(i, world_->world, caches(), job_.watch);
    }
    if (result.end != pipeline::LaunchEnd::Whole) return ended_early(std::move(*surveyed), result);
    if (sample.is_timed(i)) add_result(std::move(result), sum);
  }
  sample.finish(*sum);
  sum->structures = surveyed->structures;
  return std::move(*sum);
}

// Adds to `info` the frames and the files of a sequence.
void describe_sequence(const report::SequenceInfo& sequence, report::RunInfo& info) {
  info.sequence = sequence;
  for (uint64_t frame = sequence.first; frame <= sequence.last; ++frame) {
    info.frames.push_back(report::frame_folder(frame));
    info.saved.push_back(picture_of(frame));
  }
  info.saved.insert(info.saved.end(), {kAnimation, kTable});
  info.outputs.push_back({kAnimation, "animation", true});
}

}  // namespace

Exit run_frames(const Session& session, const SceneOptions& options, const LaunchOptions& launch) {
  const report::SequenceInfo sequence = sequence_of(options.sequence);
  ReadySceneJob ready(session, options, launch);
  pipeline::RenderJob& job = ready.job;
  check_motion(options, sequence, job.scene);
  job.update = structure_update(options.sequence);
  report::RunDirectory directory(
      launch.out.empty() ? fmt::format("out/{}_{}-{}-frames", job.scene.name, options.shader, launch.mode)
                         : launch.out);
  report::RunInfo info = describe_scene(session, options, launch, job);
  describe_sequence(sequence, info);
  const std::string title =
      fmt::format("{}, frames {} to {} at {:.6g} a second", title_of(job, options, launch), sequence.first,
                  sequence.last, sequence.fps);
  setup::begin_directory(directory, info, job.gpu, title);
  FrameRun frames(options, job, directory, info);
  std::vector<std::string> files;
  std::optional<LaunchSample> sample;
  if (launch.sample.wants_launches())
    sample.emplace(launch, job.gpu, job.no_skip, job.threads, LaunchSample::Traces::None);
  const pipeline::RenderResult sum = run_recorded(
      session, launch.max_cycles, directory, info,
      [&](const pipeline::LaunchWatch& watch) {
        return sample ? frames.run_sample(watch, *sample, info) : frames.run(watch);
      },
      [&](const pipeline::RenderResult& ended) {
        info.structures = structure_info(ended.structures);
        directory.write_stats(ended.statistics(), info.compact);
        files = frames.keep();
        if (sample) sample->keep(directory, info);
        files.push_back("statistics " + directory.path_of(launch.compact() ? "stats.csv" : "stats.txt"));
      });
  for (const std::string& warning : sum.warnings) fmt::print(stderr, "{}\n", warning);
  return print_result(session, launch.json, job, sum, info, title, std::move(files),
                      sample ? std::span(sample->estimates()) : std::span<const pipeline::Estimate>());
}

}  // namespace glint::app
