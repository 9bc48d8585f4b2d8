// Check of an option's number against a range, which "nan" does not pass (it passes CLI::Range: no comparison
// with it holds). SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <string>

namespace glint::app {

// From `least` to `most`, both included; infinity passes only as one of them.
inline CLI::Validator number_range(double least, double most) {
  const std::string name = fmt::format("FLOAT in [{} - {}]", least, most);
  const auto check = [=](const std::string& text) {
    double value = 0;
    const bool is_inside = CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
    return is_inside ? std::string{} : fmt::format("'{}' is no number from {} to {}", text, least, most);
  };
  return CLI::Validator(check, name, "number_range");
}

}  // namespace glint::app
