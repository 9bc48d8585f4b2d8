// Chooses launches of an application: by number, frame, label, shader, or the first ones of each pipeline.
// SPDX-License-Identifier: Apache-2.0
#include "setup/launch_selection.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <string_view>

#include "base/diagnostics.h"

namespace glint::setup {
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

uint64_t number_of_text(const std::string& text, const std::string& variable) {
  uint64_t out = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || end != text.data() + text.size())
    throw UserError(fmt::format("{}: '{}' is not a number", variable, text));
  return out;
}

bool starts_with(const std::string& text, std::string_view start) {
  return text.compare(0, start.size(), start) == 0;
}

}  // namespace

NumberList NumberList::parse(const std::string& text, const std::string& variable) {
  NumberList out;
  for_each_part(text, ',', [&](const std::string& part) {
    const size_t dash = part.find('-');
    const uint64_t from = number_of_text(trimmed(part.substr(0, dash)), variable);
    const uint64_t to =
        dash == std::string::npos ? from : number_of_text(trimmed(part.substr(dash + 1)), variable);
    if (to < from) throw UserError(fmt::format("{}: the range '{}' ends before it begins", variable, part));
    out.ranges_.push_back({from, to});
  });
  return out;
}

bool NumberList::has(uint64_t number) const {
  return std::any_of(ranges_.begin(), ranges_.end(),
                     [&](const Range& range) { return number >= range.from && number <= range.to; });
}

LaunchSelection LaunchSelection::parse(const std::string& text, const std::string& variable) {
  LaunchSelection out;
  for_each_part(text, ';', [&](const std::string& choice) { out.add(choice, variable); });
  return out;
}

void LaunchSelection::add(const std::string& choice, const std::string& variable) {
  if (choice.empty() || choice == "none") return;
  if (choice == "all") {
    all_ = true;
  } else if (const std::string kind = choice.substr(0, choice.find(' '));
             kind.size() < choice.size() &&
             (kind == "launch" || kind == "dispatch" || kind == "trace" || kind == "frame")) {
    numbers_.push_back({kind, NumberList::parse(choice.substr(kind.size() + 1), variable)});
  } else if (starts_with(choice, "first ")) {
    first_ = std::max(first_, number_of_text(trimmed(choice.substr(6)), variable));
  } else if (starts_with(choice, "label:")) {
    labels_.push_back(choice.substr(6));
  } else if (starts_with(choice, "shader:")) {
    shaders_.push_back(choice.substr(7));
  } else {
    throw UserError(
        fmt::format("{}: '{}' is none of 'all', 'none', 'launch 0,7-9', 'dispatch 0,7-9', 'trace 0,7-9', "
                    "'frame 0,7-9', 'first 2', 'label:NAME' and 'shader:NAME'",
                    variable, choice));
  }
}

bool LaunchSelection::takes(const LaunchFacts& launch) const {
  const auto has = [](const std::vector<std::string>& all, const std::string& wanted) {
    return std::find(all.begin(), all.end(), wanted) != all.end();
  };
  return all_ || launch.of_pipeline < first_ || has(shaders_, launch.shader) ||
         std::any_of(labels_.begin(), labels_.end(),
                     [&](const std::string& label) { return has(launch.labels, label); }) ||
         std::any_of(numbers_.begin(), numbers_.end(), [&](const Numbers& each) {
           if (each.kind == "frame") return each.list.has(launch.frame);
           return (each.kind == "launch" || each.kind == launch.kind) && each.list.has(launch.number);
         });
}

}  // namespace glint::setup
