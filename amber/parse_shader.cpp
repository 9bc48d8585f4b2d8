// Reads SHADER, VIRTUAL_FILE, and what a script asks of the device.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "amber/parse.h"

namespace glint::amber {
namespace {

// Returns whether a device feature makes a script unsupported. For most features the answer is no: scripts
// name many that they do not need, and the compiler refuses by name what a shader uses and Glint lacks. The
// features listed here change what a launch does, and nothing in the shader would tell.
bool is_lacking(const std::string& name) {
  for (const char* part :
       {"sparse", "nullDescriptor", "protectedMemory", "RoundingModeRTZ", "DenormFlushToZero"})
    if (name.find(part) != std::string::npos) return true;
  return false;
}

Language language_named(Parsing& p, const std::string& name) {
  if (name == "GLSL") return Language::Glsl;
  if (name == "SPIRV-ASM") return Language::SpirvText;
  if (name == "SPIRV-HEX") return Language::SpirvHex;
  if (name == "SPIRV-BIN") return Language::SpirvBinary;
  if (name == "HLSL" || name == "OPENCL-C" || name == "PASSTHROUGH") p.unsupported("shaders in " + name);
  p.wrong(fmt::format("there is no shader format '{}'", name));
}

}  // namespace

// GLSL ES requires #version before anything else, so the #line directive comes after it.
std::string at_line(const std::string& text, int first_line) {
  const size_t end = text.find('\n');
  const bool is_es = text.rfind("#version", 0) == 0 && end != std::string::npos &&
                     text.substr(0, end).find(" es") != std::string::npos;
  if (is_es)
    return fmt::format("{}\n#line {}\n{}", text.substr(0, end), first_line + 1, text.substr(end + 1));
  return std::string(size_t(first_line - 1), '\n') + text;
}

isa::Stage stage_named(Parsing& p, const std::string& name) {
  const std::map<std::string, isa::Stage> stages{
      {"compute", isa::Stage::Compute},  {"ray_generation", isa::Stage::RayGeneration},
      {"any_hit", isa::Stage::AnyHit},   {"closest_hit", isa::Stage::ClosestHit},
      {"miss", isa::Stage::Miss},        {"intersection", isa::Stage::Intersection},
      {"callable", isa::Stage::Callable}};
  if (const auto found = stages.find(name); found != stages.end()) return found->second;
  for (const char* graphics :
       {"vertex", "fragment", "geometry", "tessellation_evaluation", "tessellation_control", "mesh", "task"})
    if (name == graphics) p.unsupported(fmt::format("graphics: {} shaders", name));
  p.wrong(fmt::format("there is no shader type '{}'", name));
}

void parse_shader(Parsing& p) {
  Shader shader;
  const std::string type = p.tokens.word("the shader's type");
  if (type != "multi") shader.stage = stage_named(p, type);
  shader.name = p.tokens.word("the shader's name");
  shader.language = language_named(p, p.tokens.word("the shader's format"));
  if (p.tokens.accept("TARGET_ENV")) shader.target_env = p.tokens.word("the target environment");
  shader.path = p.tokens.file();
  const bool is_virtual = p.tokens.peek().is("VIRTUAL_FILE"), is_file = p.tokens.peek().is("FILE");
  if (is_virtual || is_file) {
    p.tokens.next();
    shader.path = p.tokens.word("the file");
    shader.text = p.read_file(shader.path);
  } else {
    int first_line = 1;
    const std::string text = p.tokens.raw_until_end(first_line);
    shader.text = shader.language == Language::SpirvHex ? text : at_line(text, first_line);
  }
  p.declare(p.script.shaders, shader.name, "shader") = shader;
}

void parse_virtual_file(Parsing& p) {
  const std::string name = p.tokens.word("the file's name");
  int first_line = 0;
  p.declare(p.script.virtual_files, name, "virtual file") = p.tokens.raw_until_end(first_line);
}

void parse_device(Parsing& p, const std::string& command) {
  const std::string name = p.tokens.word("a name");
  if (is_lacking(name)) p.unsupported(command + " " + name);
  p.script.features.insert(name);
}

}  // namespace glint::amber
