// Compiles the shaders of scripts: GLSL, and SPIR-V as text, as hexadecimal words and as a file.
// SPDX-License-Identifier: Apache-2.0
#include "amber/compile.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

#include "frontend/compile.h"
#include "frontend/spirv/clamped_indices.h"
#include "frontend/spirv/limits.h"
#include "frontend/spirv/specialize.h"
#include "frontend/spirv/spirv.h"
#include "pipeline/linked_shaders.h"

namespace glint::amber {
namespace {

// Returns the SPIR-V version that a target environment of the SPIR-V tools names, in the form of a module's
// second word. A shader without a target environment has spv1.0.
uint32_t version_of(const Shader& shader) {
  const std::map<std::string, uint32_t> versions{
      {"", 0x1'0000},          {"spv1.0", 0x1'0000},          {"spv1.1", 0x1'0100},
      {"spv1.2", 0x1'0200},    {"spv1.3", 0x1'0300},          {"spv1.4", 0x1'0400},
      {"spv1.5", 0x1'0500},    {"spv1.6", 0x1'0600},          {"vulkan1.0", 0x1'0000},
      {"vulkan1.1", 0x1'0300}, {"vulkan1.1spv1.4", 0x1'0400}, {"vulkan1.2", 0x1'0500},
      {"vulkan1.3", 0x1'0600}};
  const auto found = versions.find(shader.target_env);
  if (found == versions.end())
    throw UnsupportedError(fmt::format("{}: unsupported: target environment '{}' of shader '{}'", shader.path,
                                       shader.target_env, shader.name));
  return found->second;
}

std::vector<uint32_t> from_hex(const Shader& shader) {
  std::vector<uint32_t> words;
  std::string text = shader.text;
  std::replace(text.begin(), text.end(), ',', ' ');
  const char* blank = " \t\r\n";
  for (size_t at = text.find_first_not_of(blank); at != std::string::npos;
       at = text.find_first_not_of(blank, at)) {
    const size_t end = std::min(text.find_first_of(blank, at), text.size());
    const std::string word = text.substr(at, end - at);
    char* rest = nullptr;
    const uint64_t value = std::strtoull(word.c_str(), &rest, 16);
    if (*rest || value > 0xffff'ffff)
      throw UserError({shader.path, 0, 0},
                      fmt::format("shader '{}': '{}' is not a word of 32 bits", shader.name, word));
    words.push_back(uint32_t(value));
    at = end;
  }
  return words;
}

void add_attachments(const Script& script, const Pipeline& pipeline, std::vector<Attachment>& out) {
  const auto is_new = [&](const std::string& name) {
    return std::none_of(out.begin(), out.end(), [&](const Attachment& a) { return a.shader == name; });
  };
  const auto add = [&](Attachment attachment) {
    attachment.is_clamped = pipeline.clamped.count(attachment.shader) != 0;
    out.push_back(std::move(attachment));
  };
  for (const Attachment& each : pipeline.shaders)
    if (is_new(each.shader)) add(each);
  for (const auto& [group, shaders] : pipeline.groups)
    for (const std::string& name : shaders) {
      if (!is_new(name)) continue;
      Attachment attachment;
      attachment.shader = name, attachment.stage = script.shaders.at(name).stage;
      if (!attachment.stage)
        throw UserError(pipeline.where,
                        fmt::format("'{}' is a multi shader: ATTACH must give its TYPE", name));
      add(std::move(attachment));
    }
  for (const std::string& library : pipeline.libraries)
    add_attachments(script, script.pipelines.at(library), out);
}

// Returns why a module is invalid, or an empty text. Choice: a module that is invalid in the version of its
// TARGET_ENV but valid in a later version is treated as one of the later version. Scripts leave out
// TARGET_ENV and ask for VK_KHR_spirv_1_4, or use what a device's Vulkan version includes.
std::string why_invalid(std::vector<uint32_t>& words) {
  const std::string first = frontend::validate_spirv(words);
  if (first.empty()) return first;
  const uint32_t stated = words[1];
  for (const uint32_t later : {0x1'0300, 0x1'0400, 0x1'0500, 0x1'0600}) {
    if (later <= stated) continue;
    words[1] = later;
    if (frontend::validate_spirv(words).empty()) return {};
  }
  words[1] = stated;
  return first;
}

}  // namespace

namespace {

std::vector<uint32_t> assemble_or_compile(const Shader& shader, isa::Stage stage,
                                          frontend::ShaderCache* cache) {
  std::vector<uint32_t> words;
  switch (shader.language) {
    case Language::Glsl: {
      frontend::GlslOptions options;
      options.cache = cache;
      return frontend::glsl_text_to_spirv(shader.text, shader.path, stage, options);
    }
    case Language::SpirvHex:
      words = from_hex(shader);
      frontend::check_limits(words, shader.path, frontend::kDeepestValidated);
      return words;
    case Language::SpirvBinary:
      if (shader.text.size() % 4)
        throw UserError({shader.path, 0, 0}, "not a SPIR-V module: it does not consist of words");
      words.resize(shader.text.size() / 4);
      std::memcpy(words.data(), shader.text.data(), shader.text.size());
      frontend::check_limits(words, shader.path, frontend::kDeepestValidated);
      return words;
    case Language::SpirvText:
      break;
  }
  const uint32_t version = version_of(shader);
  words = frontend::assemble_spirv(shader.text, shader.path);
  words.at(1) = version;
  return words;
}

}  // namespace

std::vector<uint32_t> spirv_of(const Shader& shader, isa::Stage stage, frontend::ShaderCache* cache) {
  try {
    return assemble_or_compile(shader, stage, cache);
  } catch (const UserError& error) {
    // The shader needs a newer assembler or GLSL compiler than Glint was built with, which is not a mistake
    // of the script.
    const std::string message = error.what();
    for (const char* unknown : {"Invalid capability '", "Invalid Opcode name '", "extension not supported: "})
      if (message.find(unknown) != std::string::npos)
        throw UnsupportedError(
            fmt::format("{}: unsupported: shader '{}'\n{}", shader.path, shader.name, message));
    throw;
  }
}

CompiledShader compile(const Script& script, const Attachment& attachment,
                       const pipeline::CompilerParams& compiler, frontend::ShaderCache* cache) {
  const Shader& shader = script.shaders.at(attachment.shader);
  std::vector<uint32_t> words = spirv_of(shader, *attachment.stage, cache);
  const std::string title = shader.name;
  const std::string invalid = shader.language == Language::Glsl ? ""  // It was validated where it was made.
                              : words.size() < 5                ? "too short to hold a header"
                                                                : why_invalid(words);
  if (!invalid.empty())
    throw UserError({shader.path, 0, 0}, fmt::format("shader '{}' is invalid SPIR-V\n{}", title, invalid));
  const auto validity = attachment.is_clamped ? frontend::Validity::Unknown : frontend::Validity::Known;
  if (attachment.is_clamped)
    words =
        frontend::with_clamped_indices(frontend::specialize(std::move(words), attachment.constants), title);
  Diagnostics notes;
  pipeline::CompiledStage stage = pipeline::compile_stage(
      std::move(words), {title, attachment.entry, attachment.constants, validity}, compiler, notes, cache);
  CompiledShader out{shader.name, std::move(stage.program), std::move(stage.reflection)};
  if (out.program.stage != *attachment.stage)
    throw UserError({shader.path, 0, 0}, fmt::format("entry point '{}' of shader '{}' has another stage",
                                                     attachment.entry, title));
  return out;
}

std::vector<CompiledShader> compile(const Script& script, const Pipeline& pipeline,
                                    const pipeline::CompilerParams& compiler, frontend::ShaderCache* cache) {
  std::vector<Attachment> attachments;
  add_attachments(script, pipeline, attachments);
  std::vector<CompiledShader> out;
  for (const Attachment& each : attachments) out.push_back(compile(script, each, compiler, cache));
  return out;
}

std::vector<std::pair<std::string, std::vector<std::string>>> all_groups(const Script& script,
                                                                         const Pipeline& pipeline) {
  auto out = pipeline.groups;
  for (const std::string& library : pipeline.libraries)
    for (const auto& group : all_groups(script, script.pipelines.at(library))) out.push_back(group);
  return out;
}

}  // namespace glint::amber
