// `glint imgdiff A B`: how far apart two pictures are, with an exit code for scripts.
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "apps/glint/session.h"
#include "report/image_compare.h"
#include "report/image_files.h"

namespace glint::app {
namespace {

struct Options {
  std::string a, b, out;
  double min_psnr = 0;
};

// A run directory stands for its picture with all digits.
std::string picture_of(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_directory(path, error) ? path + "/image.pfm" : path;
}

std::string png_of(const report::Picture& picture) {
  std::vector<float> rgba(picture.rgb.size() / 3 * 4, 1.0f);
  for (size_t i = 0; i < picture.rgb.size(); ++i) rgba[i / 3 * 4 + i % 3] = picture.rgb[i];
  return report::png_bytes({picture.width, picture.height, rgba});
}

Exit imgdiff(const Options& options) {
  const report::Picture a = report::read_picture(picture_of(options.a)), b = report::read_picture(picture_of(options.b));
  const report::ImageDifference d = report::difference(a, b);
  const uint64_t pixels = uint64_t(a.width) * a.height;
  const std::string ssim = std::isnan(d.ssim) ? "- (the picture is smaller than the window of 11x11)" : fmt::format("{:.6f}", d.ssim);
  write_output("", report::table({{"pixels apart", report::with_thousands(d.pixels_apart), fmt::format("of {}", report::with_thousands(pixels))},
                                  {"largest", fmt::format("{:.6g}", d.largest), "of any channel"},
                                  {"MSE", fmt::format("{:.6g}", d.mse), "mean over pixels and channels"},
                                  {"PSNR", std::isinf(d.psnr) ? "inf" : fmt::format("{:.2f}", d.psnr), "dB, peak 1"},
                                  {"SSIM", ssim, "of luminance"}},
                                 "<><"));
  if (!options.out.empty()) write_output(options.out, png_of(report::difference_picture(a, b, d.largest)));
  if (d.psnr >= options.min_psnr) return Exit::Ok;
  fmt::print(stderr, "failed: PSNR below {} dB\n", options.min_psnr);
  return Exit::Failure;
}

}  // namespace

void add_imgdiff(CLI::App& app, Session& session) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("imgdiff", "Measure how far apart two pictures are");
  command->add_option("A", options->a, "PFM or PNG file, or a run directory (its image.pfm)")->required();
  command->add_option("B", options->b, "The other one")->required();
  command->add_option("-o,--out", options->out, "PNG of the difference, the largest as white");
  command->add_option("--min-psnr", options->min_psnr, "[dB] Exit with 1 when PSNR is below this");
  command->callback([&session, options] { session.action = [options] { return imgdiff(*options); }; });
}

}  // namespace glint::app
