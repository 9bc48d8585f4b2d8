// Compiles the shaders of a description.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/modules.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <regex>
#include <utility>

#include "exec/image.h"
#include "frontend/spirv/spirv.h"
#include "pipeline/description/data.h"
#include "pipeline/linked_shaders.h"

namespace glint::pipeline {
namespace {

std::string read_file(const std::string& path, const SourceLocation& where) {
  std::error_code failed;
  std::ifstream in(path, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(path, failed))
    throw UserError(where, fmt::format("cannot read the shader '{}'", path));
  return {std::istreambuf_iterator<char>(in), {}};
}

bool is_binary(const std::string& path) {
  return path.ends_with(".spv") || path.ends_with(".spvasm");
}

int line_of(const std::string& text, size_t at) {
  return 1 + int(std::count(text.begin(), text.begin() + long(at), '\n'));
}

// Returns the bits of a specialisation constant.
uint64_t bits_of(const Value& value, const frontend::SpecConstant& constant, Diagnostics& errors) {
  std::byte bytes[8]{};
  const std::string type = constant.number == "bool" ? "u8" : constant.number;
  Value number = value;
  if (type == "u8" && value.kind == Value::Kind::Bool)
    number.kind = Value::Kind::Integer, number.whole = value.flag;
  if (!put_number(
          type, number, [](const std::string&) { return uint64_t{0}; }, bytes))
    errors.error(value.where, fmt::format("the specialisation constant is of type {}", constant.number));
  uint64_t out = 0;
  std::memcpy(&out, bytes, sizeof out);
  return out;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

const char* name_of(frontend::BindingKind kind) {
  constexpr const char* kNames[] = {"uniform buffer",  "storage buffer",         "storage image",
                                    "sampled image",   "acceleration structure", "sampler",
                                    "unknown resource"};
  static_assert(std::size(kNames) == size_t(frontend::BindingKind::Other) + 1);
  return kNames[size_t(kind)];
}

std::vector<uint32_t> read_module(const std::string& path, const frontend::GlslOptions& glsl) {
  if (!is_binary(path)) return frontend::glsl_to_spirv(path, glsl);
  const std::string bytes = read_file(path, {});
  if (path.ends_with(".spvasm")) return frontend::assemble_spirv(bytes, path);
  constexpr size_t kHeaderBytes = 20;
  if (bytes.size() < kHeaderBytes)
    throw UserError({path, 0, 0},
                    fmt::format("this is not a SPIR-V module: it has {} bytes, and a module has at least {}",
                                bytes.size(), kHeaderBytes));
  if (bytes.size() % 4 != 0)
    throw UserError({path, 0, 0}, "this is not a SPIR-V module: its size is not a multiple of 4");
  std::vector<uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), bytes.size());
  if (words[0] == 0x0302'2307)  // the magic number tells the byte order (SPIR-V specification 2.3)
    for (uint32_t& word : words) word = __builtin_bswap32(word);
  return words;
}

SourceLocation ShaderModule::where_declared(const frontend::Binding& binding) const {
  // This matches layout(... binding = N ...) up to the declaration's end; the set may be left out when it is
  // 0.
  const std::regex layout(R"(layout\s*\(([^)]*)\)[^;{]*)");
  for (std::sregex_iterator it(text.begin(), text.end(), layout), end; it != end; ++it) {
    const std::string inside = (*it)[1].str();
    std::smatch number;
    if (!std::regex_search(inside, number, std::regex(R"(\bbinding\s*=\s*(\d+))")) ||
        std::stoul(number[1]) != binding.binding)
      continue;
    const bool has_set = std::regex_search(inside, number, std::regex(R"(\bset\s*=\s*(\d+))"));
    if ((has_set ? std::stoul(number[1]) : 0) == binding.set)
      return {path, line_of(text, size_t(it->position())), 0};
  }
  return {path, 0, 0};
}

SourceLocation ShaderModule::where_declared(const std::string& word) const {
  const size_t at = text.find(word);
  return {path, at == std::string::npos ? 0 : line_of(text, at), 0};
}

Modules::Modules(const PipelineDescription& description, const CompilerParams& compiler, bool only_reflect) {
  for (const ShaderFile& file : description.shaders) compile(file, description, compiler, only_reflect);
  Diagnostics errors;
  for (size_t i = 0; i < modules_.size(); ++i) merge(modules_[i], simplified_[i], errors);
  for (const auto& [name, value] : description.specialization.table)
    if (!constants_met_.count(name))
      errors.error(value.where, fmt::format("no shader has a specialisation constant '{}'", name));
  errors.throw_if_errors();
}

void Modules::compile(const ShaderFile& file, const PipelineDescription& description,
                      const CompilerParams& compiler, bool only_reflect) {
  ShaderModule module;
  module.name = file.name, module.path = file.path;
  const std::string text = read_file(file.path, file.where);
  if (!is_binary(file.path)) module.text = text;
  std::vector<uint32_t> words = read_module(file.path, file.glsl);
  module.constants = frontend::spec_constants(words, file.path);
  std::map<uint32_t, uint64_t> values;
  Diagnostics errors, notes;
  for (const auto& [name, value] : description.specialization.table)
    for (frontend::SpecConstant& constant : module.constants) {
      if (constant.name != name && !(is_number(name) && std::stoul(name) == constant.id)) continue;
      constants_met_.insert(name);
      values[constant.id] = bits_of(value, constant, errors);
    }
  errors.throw_if_errors();
  const auto validity = is_binary(file.path) ? frontend::Validity::Unknown : frontend::Validity::Known;
  std::vector<uint32_t> simplified;
  if (only_reflect) {
    words = frontend::specialize(std::move(words), values);
    module.reflection = frontend::reflect(words, file.path, file.entry);
    simplified =
        frontend::simplify(words, file.path, notes, values.empty() ? validity : frontend::Validity::Unknown);
  } else {
    CompiledStage stage = compile_stage(std::move(words), {file.path, file.entry, values, validity}, compiler,
                                        notes, file.glsl.cache);
    module.reflection = std::move(stage.reflection), simplified = std::move(stage.simplified);
    module.program = std::move(stage.program);
  }
  simplified_.push_back(frontend::reflect(simplified, file.path, file.entry));
  module.reflection.local_size = simplified_.back().local_size;
  warnings.insert(warnings.end(), notes.messages().begin(), notes.messages().end());
  modules_.push_back(std::move(module));
}

void Modules::merge(const ShaderModule& module, const frontend::Reflection& simplified, Diagnostics& errors) {
  for (const frontend::Binding& binding : module.reflection.bindings) {
    const auto [it, is_new] =
        bindings_.try_emplace({binding.set, binding.binding}, BindingUse{&module, binding, false});
    BindingUse& use = it->second;
    for (const frontend::Binding& other : simplified.bindings)
      use.is_used |= other.set == binding.set && other.binding == binding.binding;
    if (is_new) continue;
    if (binding.kind != use.binding.kind)
      errors.error(
          module.where_declared(binding),
          fmt::format("set {} binding {} ('{}') is a {} here and a {} at {}", binding.set, binding.binding,
                      binding.name, name_of(binding.kind), name_of(use.binding.kind),
                      use.module->where_declared(use.binding).to_string()));
    if (binding.block.bytes > use.binding.block.bytes)
      use.binding.block = binding.block, use.module = &module;
    use.binding.count = std::max(use.binding.count, binding.count);
  }
}

const ShaderModule& Modules::find(const std::string& name) const {
  return modules_[index_of(name)];
}

uint32_t Modules::index_of(const std::string& name) const {
  if (name.empty()) return exec::kNoShader;
  for (size_t i = 0; i < modules_.size(); ++i)
    if (modules_[i].name == name) return uint32_t(i);
  return exec::kNoShader;
}

}  // namespace glint::pipeline
