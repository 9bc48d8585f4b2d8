// Parses the command line. This is the only file that includes CLI11, whose header takes seconds to compile.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

namespace glint::app {

Option Option::required() {
  option_->required();
  return *this;
}

Option Option::positive() {
  const auto check = [](const std::string& text) {
    double value = 0;
    const bool is_positive = CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value);
    return is_positive ? std::string{} : fmt::format("'{}' is not a number above 0", text);
  };
  option_->check(CLI::Validator(check, "POSITIVE", "positive"));
  return *this;
}

Option Option::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

template <class T>
Option Option::in_range(T least, T most) {
  const auto check = [=](const std::string& text) {
    T value = 0;
    // The parser takes -1 for the largest number where T has no sign.
    const bool is_number =
        CLI::detail::lexical_cast(text, value) && !(std::is_unsigned_v<T> && text.starts_with('-'));
    return is_number && value >= least && value <= most
               ? std::string{}
               : fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
  };
  option_->check(CLI::Validator(
      check, fmt::format("{} in [{} - {}]", CLI::detail::type_name<T>(), least, most), "in_range"));
  return *this;
}
template Option Option::in_range(int, int);
template Option Option::in_range(uint32_t, uint32_t);
template Option Option::in_range(uint64_t, uint64_t);

// Lets only numbers of the range pass. CLI::Range would accept "nan", because no comparison with it holds.
Option Option::number_range(double least, double most) {
  const auto check = [=](const std::string& text) {
    double value = 0;
    const bool is_inside = CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
    return is_inside ? std::string{} : fmt::format("'{}' is not a number from {} to {}", text, least, most);
  };
  option_->check(CLI::Validator(check, fmt::format("FLOAT in [{} - {}]", least, most), "number_range"));
  return *this;
}

Option Option::type_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option Option::capture_default_str() {
  option_->capture_default_str();
  return *this;
}

Option Option::envname(const std::string& name) {
  option_->envname(name);
  return *this;
}

Option Option::delimiter(char mark) {
  option_->delimiter(mark);
  return *this;
}

Option Option::group(const std::string& name) {
  option_->group(name);
  return *this;
}

Option Option::allow_extra_args(bool allowed) {
  option_->allow_extra_args(allowed);
  return *this;
}

Option Option::needs(const Option& other) {
  option_->needs(other.option_);
  return *this;
}

void exclude_each_other(const std::vector<Option>& options) {
  for (const Option& option : options)
    for (const Option& other : options)
      if (option.option_ != other.option_) option.option_->excludes(other.option_);
}

Command Command::add_subcommand(const std::string& name, const std::string& doc) {
  return Command(app_->add_subcommand(name, doc));
}

template <class T>
Option Command::add_option(const std::string& names, T& variable, const std::string& doc) {
  CLI::Option* option = app_->add_option(names, variable, doc);
  // A script whose variable is unset gives an empty text, which would count as if the option were not there.
  const auto check = [](const std::string& text) {
    return text.empty() ? "its value is empty" : std::string{};
  };
  option->check(CLI::Validator(check, "", "not_empty"));
  return Option(option);
}
template Option Command::add_option(const std::string&, std::string&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, int&, const std::string&);
template Option Command::add_option(const std::string&, uint32_t&, const std::string&);
template Option Command::add_option(const std::string&, uint64_t&, const std::string&);
template Option Command::add_option(const std::string&, double&, const std::string&);

Option Command::add_flag(const std::string& names, bool& variable, const std::string& doc) {
  return Option(app_->add_flag(names, variable, doc));
}

Option Command::add_parsed_option(const std::string& names,
                                  std::function<std::string(const std::string&)> read,
                                  const std::string& doc) {
  const auto take = [names, read = std::move(read)](const std::string& text) {
    if (const std::string wrong = read(text); !wrong.empty()) throw CLI::ValidationError(names, wrong);
  };
  return Option(app_->add_option_function<std::string>(names, take, doc));
}

Command Command::callback(std::function<void()> action) {
  app_->callback(std::move(action));
  return *this;
}

size_t Command::count(const std::string& name) const {
  return app_->count(name);
}

void Command::last_value_wins() {
  for (CLI::Option* option : app_->get_options())
    if (!option->get_positional() && option->get_items_expected_max() == 1) option->take_last();
}

void Command::options_reach_subcommands() {
  app_->fallthrough();
}

std::vector<std::string> Command::option_names() const {
  std::vector<std::string> names;
  for (const CLI::Option* option : app_->get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> Command::subcommand_names() const {
  std::vector<std::string> names;
  for (const CLI::App* command : app_->get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

Command Command::subcommand(const std::string& name) const {
  return Command(app_->get_subcommand(name));
}

CommandLine::CommandLine(const std::string& doc, const std::string& name, const std::string& version)
    : app_(new CLI::App(doc, name)) {
  app_->set_version_flag("--version", version);
  app_->require_subcommand(1);
}

CommandLine::~CommandLine() {
  delete app_;
}

namespace {

// Turns "help", "help COMMAND" and "version", which other tools know as commands, into options.
std::vector<std::string> in_option_form(std::vector<std::string> words) {
  const std::string first = words.empty() ? "" : words[0];
  if (first == "version") words[0] = "--version";
  if (first == "help") {
    words.erase(words.begin());
    words.push_back("--help");
  }
  return words;
}

// Returns a message about numbers without a range in the form of all others. CLI11 says "Could not convert:
// NAME = TEXT".
std::string message_of(const std::string& said) {
  constexpr std::string_view kStart = "Could not convert: ";
  const size_t at = said.find(" = ");
  if (!said.starts_with(kStart) || at == std::string::npos) return said;
  return fmt::format("{}: '{}' is not a whole number from 0 on",
                     said.substr(kStart.size(), at - kStart.size()), said.substr(at + 3));
}

}  // namespace

ParseOutcome CommandLine::parse(int argc, char** argv) {
  try {
    std::vector<std::string> words = in_option_form({argv + 1, argv + argc});
    std::reverse(words.begin(), words.end());  // CLI11 takes the last word first.
    app_->parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    const std::vector<std::string> unknown = app_->remaining();
    if (app_->get_subcommands().empty() && !unknown.empty() && !unknown[0].starts_with('-'))
      return {false, fmt::format("there is no command '{}'", unknown[0]), {}};
    if (error.get_exit_code() != 0) return {false, message_of(error.what()), {}};
    std::ostringstream out;
    app_->exit(error, out, out);
    return {true, {}, out.str()};
  }
  return {};
}

}  // namespace glint::app
