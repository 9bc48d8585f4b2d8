// Declares `glint imgdiff A B`, which measures how far apart two pictures are, with an exit code for scripts.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <memory>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/run_files.h"
#include "apps/glint/session.h"
#include "report/files/file_list.h"
#include "report/files/run_record.h"
#include "report/picture/flip.h"
#include "report/picture/image_compare.h"
#include "report/picture/image_files.h"

namespace glint::app {
namespace {

struct ImgdiffOptions {
  std::string a, b, out, metric = "difference";
  double min_psnr = 0, max_flip = 1, pixels_per_degree = report::kPixelsPerDegree;
};

constexpr const char* kPicture = "image.pfm";  // the picture of a run with all digits

// Returns the path of a picture. A run directory stands for its picture, which must be as the run left it.
std::string picture_of(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return path;
  const std::string picture = path + "/" + kPicture;
  if (!std::filesystem::exists(path + "/run.json", error) && std::filesystem::exists(picture, error))
    return picture;
  report::check_finished(path);
  report::ListedFiles::of_run(path).read(kPicture);
  tell_of_files({path});
  return picture;
}

std::string png_of(const report::Picture& picture) {
  std::vector<float> rgba(picture.rgb.size() / 3 * 4, 1.0f);
  for (size_t i = 0; i < picture.rgb.size(); ++i) rgba[i / 3 * 4 + i % 3] = picture.rgb[i];
  return report::png_bytes({picture.width, picture.height, rgba});
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
void tell_not_finite(const ImgdiffOptions& options, const report::Picture& a, const report::Picture& b,
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
             options.a, pixel(b), options.b);
}

report::Picture drawn(const ImgdiffOptions& options, const report::Picture& a, const report::Picture& b,
                      double largest, const report::Flip& flip) {
  if (options.metric != "flip") return report::difference_picture(a, b, largest);
  report::Picture out = report::flip_picture(a, flip);
  report::mark_beyond_measure(a, b, out);
  return out;
}

Exit imgdiff(const ImgdiffOptions& options) {
  const report::Picture a = report::read_picture(picture_of(options.a)),
                        b = report::read_picture(picture_of(options.b));
  const report::ImageDifference d = report::difference(a, b);
  const report::Flip flip = report::flip(a, b, options.pixels_per_degree);
  write_output("", measures(a, d, flip, options.pixels_per_degree));
  if (!options.out.empty()) write_output(options.out, png_of(drawn(options, a, b, d.largest, flip)));
  tell_not_finite(options, a, b, d);
  if (d.psnr < options.min_psnr) fmt::print(stderr, "failed: PSNR below {} dB\n", options.min_psnr);
  if (flip.mean > options.max_flip)
    fmt::print(stderr, "failed: FLIP {:.6f} is above {}\n", flip.mean, options.max_flip);
  return d.pixels_beyond_measure > 0 || d.psnr < options.min_psnr || flip.mean > options.max_flip
             ? Exit::Failure
             : Exit::Ok;
}

}  // namespace

void add_imgdiff(Command app, Session& session) {
  auto options = std::make_shared<ImgdiffOptions>();
  Command command = app.add_subcommand("imgdiff", "Measure how far apart two pictures are");
  command
      .add_option("A", options->a,
                  "First picture: a PFM or PNG file, or a run directory, which stands for its image.pfm")
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
