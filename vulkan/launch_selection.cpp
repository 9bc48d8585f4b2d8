// Chooses launches of an application: by number, label, shader, or the first ones of each pipeline.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/launch_selection.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <string_view>

#include "base/diagnostics.h"

namespace glint::vulkan {
namespace {

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

// Calls `visit` with each part of a text that a character separates, without blanks around it.
template <class Visit>
void for_each_part(const std::string& text, char separator, Visit&& visit) {
  for (size_t at = 0; at <= text.size();) {
    const size_t end = std::min(text.find(separator, at), text.size());
    visit(trimmed(text.substr(at, end - at)));
    at = end + 1;
  }
}

uint64_t number_of_text(const std::string& text) {
  uint64_t out = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || end != text.data() + text.size())
    throw UserError(fmt::format("GLINT_TIMING: '{}' is not a number", text));
  return out;
}

bool starts_with(const std::string& text, std::string_view start) {
  return text.compare(0, start.size(), start) == 0;
}

}  // namespace

LaunchSelection LaunchSelection::parse(const std::string& text) {
  LaunchSelection out;
  for_each_part(text, ';', [&](const std::string& choice) { out.add(choice); });
  return out;
}

void LaunchSelection::add(const std::string& choice) {
  if (choice.empty() || choice == "none") return;
  if (choice == "all") {
    all_ = true;
  } else if (const std::string kind = choice.substr(0, choice.find(' '));
             kind.size() < choice.size() && (kind == "launch" || kind == "dispatch" || kind == "trace")) {
    add_numbers(kind, choice.substr(kind.size() + 1));
  } else if (starts_with(choice, "first ")) {
    first_ = std::max(first_, number_of_text(trimmed(choice.substr(6))));
  } else if (starts_with(choice, "label:")) {
    labels_.push_back(choice.substr(6));
  } else if (starts_with(choice, "shader:")) {
    shaders_.push_back(choice.substr(7));
  } else {
    throw UserError(
        fmt::format("GLINT_TIMING: '{}' is none of 'all', 'none', 'launch 0,7-9', 'dispatch 0,7-9', "
                    "'trace 0,7-9', 'first 2', 'label:NAME' and 'shader:NAME'",
                    choice));
  }
}

void LaunchSelection::add_numbers(const std::string& kind, const std::string& list) {
  for_each_part(list, ',', [&](const std::string& part) {
    const size_t dash = part.find('-');
    const uint64_t from = number_of_text(trimmed(part.substr(0, dash)));
    const uint64_t to = dash == std::string::npos ? from : number_of_text(trimmed(part.substr(dash + 1)));
    if (to < from) throw UserError(fmt::format("GLINT_TIMING: the range '{}' ends before it begins", part));
    numbers_.push_back({kind, from, to});
  });
}

bool LaunchSelection::takes(const LaunchFacts& launch) const {
  const auto has = [](const std::vector<std::string>& all, const std::string& wanted) {
    return std::find(all.begin(), all.end(), wanted) != all.end();
  };
  return all_ || launch.of_pipeline < first_ || has(shaders_, launch.shader) ||
         std::any_of(labels_.begin(), labels_.end(),
                     [&](const std::string& label) { return has(launch.labels, label); }) ||
         std::any_of(numbers_.begin(), numbers_.end(), [&](const Range& range) {
           return (range.kind == "launch" || range.kind == launch.kind) && launch.number >= range.from &&
                  launch.number <= range.to;
         });
}

}  // namespace glint::vulkan
