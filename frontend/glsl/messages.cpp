// Turns glslang's messages into errors with the user's files and lines.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/glsl/messages.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <sstream>
#include <string_view>

#include "base/diagnostics.h"
#include "frontend/glsl/includer.h"

namespace glint::frontend {
namespace {

constexpr int kLinesBeforeDefines = 1;  // lines of the preamble before the first define

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

// An extension that a shader only enables is a warning.
bool refuses_extension(const std::string& line) {
  return line.rfind("ERROR: ", 0) == 0 && contains(line, "extension not supported:");
}

struct Version {
  int line = 0, number = 0;  // 0: the shader does not say its version
};

Version version_of(const std::string& text) {
  std::istringstream lines(text);
  Version version;
  for (std::string line; std::getline(lines, line);) {
    ++version.line;
    std::istringstream words(line);
    char hash = 0;
    std::string directive;
    if (words >> hash >> directive && hash == '#' && directive == "version") {
      words >> version.number;
      return version;
    }
  }
  return {};
}

// Returns the place of the #version line, or of line 1 when the shader has none.
std::string place_of_version(const CompiledText& shader) {
  return fmt::format("{}:{}", shader.path, std::max(1, version_of(shader.text).line));
}

// Returns the place of a message in terms of the user's files. glslang calls the text before the shader "-1",
// and gives no place for errors of linking.
std::string place_in_files(const std::string& place, const CompiledText& shader) {
  if (place.rfind("Linking ", 0) == 0) return shader.path;
  if (place == "#version") return place_of_version(shader);
  if (place.rfind("-1:", 0) != 0) return place;
  const int define = std::atoi(place.c_str() + 3) - 1 - kLinesBeforeDefines;
  const auto& defines = shader.options.defines;
  if (define < 0 || define >= int(defines.size())) return shader.path;
  const auto& [name, value] = defines[size_t(define)];
  return fmt::format("{}: -D {}={}", shader.path, name, value);
}

// Rewrites a message from "ERROR: file:line: 'token' : text" to "file:line: error: 'token' : text". Other
// lines stay as they are.
std::string line_in_our_form(const std::string& line, const CompiledText& shader) {
  const bool is_error = line.rfind("ERROR: ", 0) == 0;
  const bool is_warning = line.rfind("WARNING: ", 0) == 0;
  if (!is_error && !is_warning) return line;
  const std::string text = line.substr(is_error ? 7 : 9);
  const std::string severity = is_error ? "error: " : "warning: ";
  if (text == "version not supported")
    return fmt::format("{}: {}this GLSL version is not supported", place_of_version(shader), severity);
  const size_t end_of_place = text.find(": ");
  if (end_of_place == std::string::npos) return fmt::format("{}: {}{}", shader.path, severity, text);
  return fmt::format("{}: {}{}", place_in_files(text.substr(0, end_of_place), shader), severity,
                     text.substr(end_of_place + 2));
}

// Returns the messages for which `keep` holds, without those that only count the errors.
template <class Keep>
std::string in_our_form(const std::string& log, const CompiledText& shader, const Keep& keep) {
  std::istringstream lines(log);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || contains(line, "compilation errors.") || contains(line, "compilation terminated") ||
        !keep(line))
      continue;
    if (!result.empty()) result += '\n';
    result += line_in_our_form(line, shader);
  }
  return result;
}

std::string in_our_form(const std::string& log, const CompiledText& shader) {
  return in_our_form(log, shader, [](const std::string&) { return true; });
}

// Returns the user's form of glslang's messages on a shader and its includes. Messages after an include that
// failed are left out, because they come only from its absence.
std::string with_includes(std::string log, const CompiledText& shader, const Includer& includer) {
  const std::string& failure = includer.failure();
  const size_t at = failure.empty() ? std::string::npos : log.find(failure);
  if (at != std::string::npos) log.resize(at + failure.size());
  std::string message = in_our_form(log, shader);
  if (failure.empty() && !includer.cycle().empty()) message += "\nnote: " + includer.cycle();
  return message;
}

}  // namespace

void refuse_old_version(const CompiledText& shader) {
  constexpr int kOldest = 140;
  const Version version = version_of(shader.text);
  if (version.number > 0 && version.number < kOldest)
    throw UserError({shader.path, version.line}, fmt::format("GLSL version {} is too old", version.number),
                    "Vulkan's GLSL begins with version 140; write #version 460");
}

void throw_messages(const std::string& log, const CompiledText& shader, const Includer* includer) {
  // What follows an unknown extension comes from its absence.
  if (const std::string refused = in_our_form(log, shader, refuses_extension); !refused.empty())
    throw UnsupportedError(refused);
  throw UserError(includer ? with_includes(log, shader, *includer) : in_our_form(log, shader));
}

}  // namespace glint::frontend
