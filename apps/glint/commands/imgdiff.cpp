// Declares `glint imgdiff A B`, which measures how far apart two pictures are, with an exit code for scripts.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <limits>
#include <memory>
#include <set>
#include <system_error>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/run_files.h"
#include "apps/glint/session.h"
#include "base/diagnostics.h"
#include "report/files/file_list.h"
#include "report/files/run_record.h"
#include "report/picture/flip.h"
#include "report/picture/image_compare.h"

namespace glint::app {
namespace {

struct ImgdiffOptions {
  std::string a, b, out, metric = "difference";
  double min_psnr = 0, max_flip = 1, pixels_per_degree = report::kPixelsPerDegree;
};

constexpr const char* kPicture = "image.pfm";  // the picture of a scene's run, with all digits

// Holds the paths of two pictures that are compared. `name` is set where a pipeline saved several.
struct PicturePair {
  std::string a, b, name;
};

// Returns the pictures of a run by name. Each must be as the run left it. The run of a scene stands for its
// picture with all digits, and the run of a pipeline for the pictures that it saved.
std::set<std::string> pictures_of(const std::string& directory) {
  report::check_finished(directory);
  const report::ListedFiles files = report::ListedFiles::of_run(directory);
  tell_of_files({directory});
  std::set<std::string> names;
  if (files.read(kPicture)) return {kPicture};
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const std::string name = entry.path().filename().string(), ending = entry.path().extension().string();
    if ((ending == ".pfm" || ending == ".exr" || ending == ".png") && files.read(name)) names.insert(name);
  }
  return names;
}

// Returns the path of a picture. A directory without run.json may have a picture, too.
std::string picture_of(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return path;
  const std::string picture = path + "/" + kPicture;
  if (!std::filesystem::exists(path + "/run.json", error) && std::filesystem::exists(picture, error))
    return picture;
  const std::set<std::string> names = pictures_of(path);
  if (names.size() != 1)
    throw UserError({path}, fmt::format("this run has {} pictures, and one is compared", names.size()),
                    "name the picture, or the directories of two runs");
  return path + "/" + *names.begin();
}

// Says which pictures only one of the runs has.
void tell_alone(const std::set<std::string>& names, const std::set<std::string>& others,
                const std::string& directory) {
  std::vector<std::string> alone;
  std::ranges::set_difference(names, others, std::back_inserter(alone));
  if (!alone.empty()) fmt::print(stderr, "note: only '{}' has {}\n", directory, fmt::join(alone, ", "));
}

// Returns what to compare: two pictures, or all that two runs have in common.
std::vector<PicturePair> pairs_of(const ImgdiffOptions& options) {
  const auto is_run = [](const std::string& path) {
    std::error_code error;
    return std::filesystem::exists(path + "/run.json", error);
  };
  if (!is_run(options.a) || !is_run(options.b)) return {{picture_of(options.a), picture_of(options.b), ""}};
  std::vector<PicturePair> pairs;
  const std::set<std::string> ours = pictures_of(options.a), others = pictures_of(options.b);
  for (const std::string& name : ours)
    if (others.contains(name)) pairs.push_back({options.a + "/" + name, options.b + "/" + name, name});
  if (!pairs.empty()) {
    tell_alone(ours, others, options.a);
    tell_alone(others, ours, options.b);
  }
  if (pairs.size() == 1) pairs[0].name.clear();
  if (pairs.empty())
    throw UserError(
        {}, fmt::format("'{}' and '{}' have no picture in common", options.a, options.b),
        "a pipeline keeps one with save = \"NAME.pfm\", \"NAME.exr\" or \"NAME.png\" under [[image]]");
  if (pairs.size() > 1 && !options.out.empty())
    throw UserError({}, fmt::format("--out takes one picture, and the runs have {} in common", pairs.size()),
                    "name the two files instead of the directories");
  return pairs;
}

std::string measures(const report::Picture& a, const report::ImageDifference& d, const report::Flip& flip,
                     double pixels_per_degree) {
  const bool is_measured = d.pixels_beyond_measure == 0;
  const auto known = [&](const std::string& text) { return is_measured ? text : "-"; };
  const bool is_small = is_measured && std::isnan(d.ssim);
  std::vector<std::vector<std::string>> rows = {
      {"pixels apart", report::with_thousands(d.pixels_apart),
       fmt::format("of {}", report::with_thousands(uint64_t(a.width) * a.height))},
      {"largest", fmt::format("{:.6g}", d.largest),
       is_measured ? "of any channel" : "of any channel, where both are finite"},
      {"MSE", known(fmt::format("{:.6g}", d.mse)), "mean over pixels and channels"},
      {"PSNR", known(std::isinf(d.psnr) ? "inf" : fmt::format("{:.2f}", d.psnr)), "dB, peak 1"},
      {"SSIM",
       is_small ? "- (the picture is smaller than the window of 11x11)"
                : known(fmt::format("{:.6f}", d.ssim)),
       "of luminance"},
      {"FLIP", known(fmt::format("{:.6f}", flip.mean)),
       fmt::format("mean, {:.6g} pixels per degree; 0: looks the same", pixels_per_degree)}};
  if (!is_measured)
    rows.insert(rows.begin() + 1, {"not finite", report::with_thousands(d.pixels_beyond_measure),
                                   "of these, in one picture or otherwise than in the other"});
  return report::table(rows, "<><");
}

// Says where pixels are not finite, because no measure shows it.
void tell_not_finite(const PicturePair& pair, const report::Picture& a, const report::Picture& b,
                     const report::ImageDifference& d) {
  if (d.pixels_not_finite > 0)
    fmt::print(stderr, "warning: not finite in both pictures, and the same: {} pixels; they count as equal\n",
               report::with_thousands(d.pixels_not_finite));
  if (d.pixels_beyond_measure == 0) return;
  const uint64_t first = d.first_beyond_measure;
  const auto pixel = [&](const report::Picture& p) {
    return fmt::format("{} {} {}", p.rgb[3 * first], p.rgb[3 * first + 1], p.rgb[3 * first + 2]);
  };
  fmt::print(stderr,
             "failed: not finite in one picture, or otherwise than in the other: {} of {} pixels; the first "
             "at x {}, y {} from the top left: {} in '{}', {} in '{}'\n"
             "note: with them there is no MSE, PSNR, SSIM or FLIP; -o draws them magenta\n",
             report::with_thousands(d.pixels_beyond_measure),
             report::with_thousands(uint64_t(a.width) * a.height), first % a.width, first / a.width, pixel(a),
             pair.a, pixel(b), pair.b);
}

report::Picture drawn(const ImgdiffOptions& options, const report::Picture& a, const report::Picture& b,
                      double largest, const report::Flip& flip) {
  if (options.metric != "flip") return report::difference_picture(a, b, largest);
  report::Picture out = report::flip_picture(a, flip);
  report::mark_beyond_measure(a, b, out);
  return out;
}

Exit compare_pair(const ImgdiffOptions& options, const PicturePair& pair) {
  const report::Picture a = report::read_picture(pair.a), b = report::read_picture(pair.b);
  const report::ImageDifference d = report::difference(a, b);
  const report::Flip flip = report::flip(a, b, options.pixels_per_degree);
  const std::string title = pair.name.empty() ? "" : fmt::format("== {}\n", pair.name);
  write_output("", title + measures(a, d, flip, options.pixels_per_degree));
  if (!options.out.empty()) write_output(options.out, report::png_of(drawn(options, a, b, d.largest, flip)));
  tell_not_finite(pair, a, b, d);
  if (d.psnr < options.min_psnr) fmt::print(stderr, "failed: PSNR below {} dB\n", options.min_psnr);
  if (flip.mean > options.max_flip)
    fmt::print(stderr, "failed: FLIP {:.6f} is above {}\n", flip.mean, options.max_flip);
  return d.pixels_beyond_measure > 0 || d.psnr < options.min_psnr || flip.mean > options.max_flip
             ? Exit::Failure
             : Exit::Ok;
}

Exit imgdiff(const ImgdiffOptions& options) {
  Exit exit = Exit::Ok;
  for (const PicturePair& pair : pairs_of(options))
    if (compare_pair(options, pair) != Exit::Ok) exit = Exit::Failure;
  return exit;
}

}  // namespace

void add_imgdiff(Command app, Session& session) {
  auto options = std::make_shared<ImgdiffOptions>();
  Command command = app.add_subcommand("imgdiff", "Measure how far apart two pictures are");
  command
      .add_option("A", options->a,
                  "First picture: a PFM, EXR, HDR, PNG or JPEG file, or a run directory, which stands for "
                  "its image.pfm or for the "
                  "pictures that its pipeline saved")
      .required();
  command.add_option("B", options->b, "Second picture").required();
  command.add_option("-o,--out", options->out, "PNG file to write the difference to; --metric selects which");
  command
      .add_option("--metric", options->metric,
                  "Selects what -o draws: the absolute difference with the largest as white, or the map of "
                  "FLIP with 0 as black and 1 as white")
      .one_of({"difference", "flip"})
      .capture_default_str();
  command
      .add_option("--min-psnr", options->min_psnr,
                  "[dB] Exit with 1 when PSNR is below this value; inf: exit with 1 when anything differs")
      .number_range(-1000, std::numeric_limits<double>::infinity());
  command.add_option("--max-flip", options->max_flip, "Exit with 1 when the mean of FLIP is above this value")
      .number_range(0, 1);
  command
      .add_option("--ppd", options->pixels_per_degree,
                  "Pixels per degree of sight that FLIP assumes; 67 is a monitor of 0.7 m with 3840 pixels "
                  "that is 0.7 m away")
      .number_range(1, 1000)
      .capture_default_str();
  command.callback([&session, options] { session.action = [options] { return imgdiff(*options); }; });
}

}  // namespace glint::app
