// Reads the share of a sampled run.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/sample_options.h"

#include <charconv>
#include <fmt/format.h>

#include "base/diagnostics.h"

namespace glint::app {

pipeline::SampleOptions SampleChoice::options() const {
  double percent = 0;
  const char* end = share.data() + share.size();
  const auto [rest, error] = std::from_chars(share.data(), end, percent, std::chars_format::fixed);
  if (error != std::errc{} || std::string(rest, end) != "%" || !(percent > 0 && percent <= 50))
    throw UserError({}, fmt::format("--sample-pixels is '{}', expected more than 0% and at most 50%", share),
                    "for example --sample-pixels 5%");
  return {percent / 100, seed};
}

void add_sample_options(Command command, SampleChoice& choice) {
  const Option share =
      command
          .add_option("--sample-pixels", choice.share,
                      "Time only this share of a frame's pixels, such as 5%, on a part of the machine, and "
                      "estimate the rest with 95 % intervals (docs/sampling.md)")
          .type_name("SHARE");
  command.add_option("--sample-seed", choice.seed, "Selects which pixels a sample has")
      .capture_default_str()
      .needs(share);
}

}  // namespace glint::app
