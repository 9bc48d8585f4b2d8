// Reads the top level of a script.
// SPDX-License-Identifier: Apache-2.0
#include "amber/parse.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace glint::amber {
namespace {

std::string read_text(const std::string& path, const SourceLocation& where) {
  std::error_code failed;
  std::ifstream in(path, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(path, failed))
    throw UserError(where, fmt::format("cannot read '{}'", path));
  return {std::istreambuf_iterator<char>(in), {}};
}

bool parse_declaration(Parsing& p, const std::string& name) {
  if (name == "SHADER")
    parse_shader(p);
  else if (name == "VIRTUAL_FILE")
    parse_virtual_file(p);
  else if (name == "DEVICE_FEATURE" || name == "DEVICE_EXTENSION" || name == "INSTANCE_EXTENSION" ||
           name == "DEVICE_PROPERTY")
    parse_device(p, name);
  else if (name == "STRUCT")
    parse_struct(p);
  else if (name == "BUFFER")
    parse_buffer(p, false);
  else if (name == "IMAGE")
    parse_buffer(p, true);
  else if (name == "SAMPLER")
    parse_sampler(p);
  else if (name == "ACCELERATION_STRUCTURE")
    parse_structure(p);
  else if (name == "PIPELINE")
    parse_pipeline(p);
  else if (name == "DERIVE_PIPELINE")
    parse_derived_pipeline(p);
  else
    return false;
  return true;
}

// Choice: time limits of fences are ignored; the limit on instructions ends a shader that would never end.
void parse_engine_data(Parsing& p) {
  const std::string what = p.tokens.word("'ENGINE_DATA'");
  if (what != "ENGINE_DATA") p.unsupported("SET " + what);
  const std::string name = p.tokens.word("the name of engine data");
  if (name != "fence_timeout_ms" && name != "max_wait_time_ms") p.unsupported("engine data " + name);
  while (p.tokens.peek().is_word()) p.tokens.number("the value of engine data");
}

}  // namespace

std::string Parsing::beside(const std::string& file) const {
  const std::filesystem::path path(file);
  return path.is_absolute() ? file : (std::filesystem::path(script.path).parent_path() / path).string();
}

std::string Parsing::read_file(const std::string& file) {
  const auto found = script.virtual_files.find(file);
  return found != script.virtual_files.end() ? found->second : read_text(beside(file), tokens.here());
}

Script parse_script(const std::string& text, const std::string& path) {
  Script script;
  script.path = path;
  if (text.rfind("#!amber", 0) != 0) {
    if (!has_sections(text)) throw UserError({path, 1, 0}, "the first line is not '#!amber'");
    parse_sections(script, text);
    return script;
  }
  Parsing p{Tokens(text, path), script};
  for (Token token = p.tokens.next_after_line_ends(); token.is_word();
       token = p.tokens.next_after_line_ends()) {
    if (token.text == "SET")
      parse_engine_data(p);
    else if (!parse_declaration(p, token.text) && !parse_command(p, token.text, script.commands))
      p.unsupported("command " + token.text);
    p.tokens.end_line();
  }
  return script;
}

Script read_script(const std::string& path) {
  return parse_script(read_text(path, {}), path);
}

}  // namespace glint::amber
