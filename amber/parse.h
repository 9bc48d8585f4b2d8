// Declares the steps of reading a script, one for each family of commands.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "amber/script.h"
#include "amber/tokens.h"

namespace glint::amber {

struct Parsing {
  Tokens tokens;
  Script& script;

  [[noreturn]] void wrong(const std::string& what) { throw UserError(tokens.here(), what); }
  [[noreturn]] void unsupported(const std::string& what) {
    throw UnsupportedError(fmt::format("{}: unsupported: {}", tokens.here().to_string(), what));
  }
  std::string beside(const std::string& file) const;  // relative paths start at the script's folder
  std::string read_file(const std::string& file);     // a virtual file comes before a real one

  // Returns what is declared by that name. Throws UserError when there is no such declaration.
  template <class T>
  T& find(std::map<std::string, T>& in, const std::string& name, const char* kind) {
    const auto found = in.find(name);
    if (found == in.end()) wrong(fmt::format("there is no {} '{}'", kind, name));
    return found->second;
  }
  template <class T>
  T& declare(std::map<std::string, T>& in, const std::string& name, const char* kind) {
    const auto [it, is_new] = in.try_emplace(name);
    if (!is_new) wrong(fmt::format("there is a {} '{}' already", kind, name));
    return it->second;
  }
};

isa::Stage stage_named(Parsing& p, const std::string& name);
// Returns a shader's text with lines that count from `first_line` on.
std::string at_line(const std::string& text, int first_line);
// Returns one number and whether it is in percent.
std::pair<double, bool> parse_tolerance(Parsing& p);

// These are in parse_shader.cpp.
void parse_shader(Parsing& p);
void parse_virtual_file(Parsing& p);
void parse_device(Parsing& p, const std::string& command);
// These are in parse_buffer.cpp.
void parse_struct(Parsing& p);
void parse_buffer(Parsing& p, bool is_image);
void parse_sampler(Parsing& p);
// This is in parse_structure.cpp.
void parse_structure(Parsing& p);
// This is in parse_pipeline.cpp.
void parse_pipeline(Parsing& p);
void parse_derived_pipeline(Parsing& p);
// These are in parse_sections.cpp, which reads the older language. Its scripts have sections such as [compute
// shader] and [test].
bool has_sections(const std::string& text);
void parse_sections(Script& script, const std::string& text);
// These are in parse_command.cpp. parse_command() returns false when `name` is none of its commands.
bool parse_command(Parsing& p, const std::string& name, std::vector<Command>& to);

}  // namespace glint::amber
