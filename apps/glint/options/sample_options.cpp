// Reads the share of a sampled run.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/sample_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>

#include "base/diagnostics.h"
#include "base/registry.h"
#include "pipeline/sampling/sample_way.h"

namespace glint::app {
namespace {

// Returns the number before `ending`, or nothing when the text has another form.
std::optional<double> number_in(const std::string& text, const std::string& ending) {
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  if (error != std::errc{} || std::string(rest, end) != ending) return std::nullopt;
  return number;
}

// Holds a number of launches, or a share of them.
struct LaunchShare {
  std::optional<double> number, percent;
};

LaunchShare launch_share(const std::string& text) {
  LaunchShare out{number_in(text, ""), number_in(text, "%")};
  const bool is_number = out.number && *out.number >= 1 && *out.number <= 1e9 &&
                         *out.number == std::floor(*out.number),
             is_share = out.percent && *out.percent > 0 && *out.percent < 100;
  if (!is_number && !is_share)
    throw UserError({},
                    fmt::format("--sample-launches is '{}', expected a number of launches or a share of them "
                                "between 0% and 100%",
                                text),
                    "for example --sample-launches 20, or --sample-launches 5%");
  return out;
}

}  // namespace

std::string SampleChoice::given() const {
  return wants_pixels() ? "--sample-pixels" : wants_launches() ? "--sample-launches" : "";
}

pipeline::SampleOptions SampleChoice::options() const {
  const std::optional<double> percent = number_in(share, "%");
  if (!percent || !(*percent > 0 && *percent <= 50))
    throw UserError({}, fmt::format("--sample-pixels is '{}', expected more than 0% and at most 50%", share),
                    "for example --sample-pixels 5%");
  return {*percent / 100, seed, by};
}

uint32_t SampleChoice::launches_of(uint32_t all, uint32_t least) const {
  const LaunchShare wanted = launch_share(launches);
  const auto count = uint32_t(wanted.number ? *wanted.number : std::ceil(*wanted.percent / 100 * all));
  const std::string asked = wanted.number ? fmt::format("{} launches", count)
                                          : fmt::format("{}, which are {} launches,", launches, count);
  if (least >= all)
    throw UserError(
        {}, fmt::format("the run has {} launch{}, and a sample needs as many", all, all == 1 ? "" : "es"),
        "it has the first launch of each kernel and two later ones; leave --sample-launches away");
  if (count >= all)
    throw UserError({}, fmt::format("a sample of {} leaves nothing out, because the run has {}", asked, all),
                    "take fewer, or leave --sample-launches away");
  if (count < least)
    throw UserError(
        {}, fmt::format("a sample of {} is too small, because the run has {}", asked, all),
        fmt::format("it has the first launch of each kernel and two later ones: at least {} ({:.3g} %)",
                    least, std::ceil(1000.0 * least / all) / 10));
  return count;
}

void add_sample_options(Command command, SampleChoice& choice) {
  command
      .add_option(
          "--sample-pixels", choice.share,
          "Time only this share of a launch's blocks, such as 5% of a frame's pixels, on a part of the "
          "machine, and estimate the rest with 95 % intervals (docs/sampling.md)")
      .type_name("SHARE");
  command
      .add_option("--sample-launches", choice.launches,
                  "Time only so many launches of a program, of a list of launches or of --frames (20, or a "
                  "share such as 5%), run the others functionally, and estimate the whole run with 95 % "
                  "intervals (docs/sampling.md)")
      .type_name("NUMBER|SHARE");
  command
      .add_option(
          "--sample-by", choice.by,
          "Selects how --sample-pixels places what it times: position spreads it over the launch, "
          "uniform puts it anywhere, cost and heat look first at what a few blocks of each place cost "
          "functionally (docs/sampling.md)")
      .one_of(Registry<pipeline::SampleWay>::names())
      .capture_default_str();
  command.add_option("--sample-seed", choice.seed, "Selects which pixels or launches a sample has")
      .in_range(uint64_t{0}, std::numeric_limits<uint64_t>::max())
      .capture_default_str();
}

void SampleChoice::note_given(const Command& command) {
  seed_given = command.count("--sample-seed") > 0;
  by_given = command.count("--sample-by") > 0;
}

void check_sample_options(const SampleChoice& choice) {
  if (choice.wants_pixels() && choice.wants_launches())
    throw UserError({}, "--sample-pixels and --sample-launches cannot be used together",
                    "the first samples one launch, and the second one many");
  check_sample_forms(choice);
}

void check_sample_forms(const SampleChoice& choice) {
  if (choice.given().empty() && choice.seed_given)
    throw UserError({}, "--sample-seed needs --sample-pixels or --sample-launches");
  if (choice.by_given && !choice.wants_pixels())
    throw UserError({}, "--sample-by needs --sample-pixels",
                    "--sample-launches chooses among clusters of launches");
  if (choice.wants_pixels()) choice.options();
  if (choice.wants_launches()) launch_share(choice.launches);
}

}  // namespace glint::app
