// Declares the command line for subcommands: commands, options, checks. CLI11 stands behind it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace glint::app {

// Holds one option or positional argument of a command. It is a handle, so a copy means the same option. Each
// function adds a rule or a part of the help and returns the option, so that rules can be chained.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required();
  Option positive();  // takes only numbers above 0
  Option one_of(const std::vector<std::string>& words);
  // Takes only numbers from `least` to `most`, both included. T is uint32_t, uint64_t or int.
  template <class T>
  Option in_range(T least, T most);
  // Does the same for a double. "nan" is refused, and infinity passes only as a bound.
  Option number_range(double least, double most);
  Option type_name(const std::string& name);  // the text that stands for the value in the help
  Option capture_default_str();               // the help shows the variable's value as the default
  Option envname(const std::string& name);    // the environment variable that also gives the value
  Option delimiter(char mark);                // the mark between several values in one word
  Option group(const std::string& name);      // the heading in the help; "" hides the option
  Option allow_extra_args(bool allowed);      // false: each use of the option takes one value
  Option needs(const Option& other);

 private:
  friend void exclude_each_other(const std::vector<Option>& options);
  CLI::Option* option_;
};

// Lets at most one of `options` be given.
void exclude_each_other(const std::vector<Option>& options);

// Holds a command or subcommand. It is a handle, so a copy means the same command. Variables that options
// fill have to live until the command line has been parsed.
class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}

  Command add_subcommand(const std::string& name, const std::string& doc);
  // Adds an option. `names` is "-o,--out" or, for a positional argument, "FILE". T is a type of the list in
  // command_line.cpp.
  template <class T>
  Option add_option(const std::string& names, T& variable, const std::string& doc);
  Option add_flag(const std::string& names, bool& variable, const std::string& doc);
  // Adds an option whose text `read` takes. `read` returns what is wrong with the text, or "" when nothing
  // is.
  Option add_parsed_option(const std::string& names, std::function<std::string(const std::string&)> read,
                           const std::string& doc);
  // Sets the function that is called when the command line has been parsed and this command was chosen.
  Command callback(std::function<void()> action);
  size_t count(const std::string& name) const;  // how often an option was given
  void last_value_wins();                       // applies to every option that takes one value
  // Lets options of this command also stand after its subcommands' names. Call it before adding subcommands.
  void options_reach_subcommands();

  std::vector<std::string> option_names() const;  // returns the long names, with their dashes
  std::vector<std::string> subcommand_names() const;
  Command subcommand(const std::string& name) const;  // the subcommand has to exist

 private:
  CLI::App* app_;
};

// Holds what parse() came to when no subcommand is to run: the exit code, text for stdout, or what was wrong.
struct ParseOutcome {
  bool is_done = false;  // --help or --version was asked for: print `text`
  std::string error;     // not empty: the command line is wrong
  std::string text;
};

// Holds the whole command line of a program.
class CommandLine {
 public:
  CommandLine(const std::string& doc, const std::string& name, const std::string& version);
  ~CommandLine();
  Command command() { return Command(app_); }
  ParseOutcome parse(int argc, char** argv);

 private:
  CLI::App* app_;
};

}  // namespace glint::app
