// Validates and disassembles SPIR-V through SPIRV-Tools.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/spirv.h"

#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <spirv-tools/libspirv.hpp>
#include <spirv/unified1/spirv.hpp11>
#include <string_view>

#include "base/regular_file.h"
#include "frontend/compile.h"
#include "frontend/deep_stack.h"
#include "frontend/spirv/known_words.h"
#include "frontend/spirv/limits.h"
#include "frontend/spirv/newer_capabilities.h"
#include "frontend/spirv/words.h"

namespace glint::frontend {

namespace {

// Returns true for messages on modules that glslang and the optimiser make and the validator rejects,
// although their meaning is plain:
// - two variables for one built-in (glslang makes one for gl_ObjectToWorldEXT and one for
// gl_ObjectToWorld3x4EXT);
// - conversions of a half to its own width (glslang);
// - pointers to buffers in local variables whose decoration the optimiser dropped;
// - members of blocks that overlap (vkd3d 1.2, push constants that only one of several shaders uses), which
// are read and written where they say;
// - barriers and atomics of device scope without the capability (glslang, Vulkan memory model without scope
// semantics).
bool is_false_alarm(std::string_view message) {
  for (const std::string_view part :
       {"has more than one BuiltIn", "already has the same BuiltIn",
        "VUID-StandaloneSpirv-OpEntryPoint-09658", "Expected component type bit width to be different",
        "bit width of Value to be different", "expected AliasedPointer or RestrictPointer",
        "requires the VulkanMemoryModelDeviceScopeKHR capability", "overlaps previous member"})
    if (message.find(part) != std::string_view::npos) return true;
  return false;
}

// Reports constants made from a component that a vector lacks. The validator accepts them, and the optimiser
// crashes on them.
std::string missing_components(const std::vector<uint32_t>& words) {
  std::map<uint32_t, uint32_t> components, type_of;  // of vector types; of constants
  for (size_t i = kHeaderWords; i < words.size(); i += words[i] >> 16) {
    const auto op = spv::Op(words[i] & 0xffff);
    const size_t length = words[i] >> 16;
    if (op == spv::Op::OpFunction) break;
    if (op == spv::Op::OpTypeVector) components[words[i + 1]] = words[i + 3];
    if (op == spv::Op::OpSpecConstantComposite || op == spv::Op::OpConstantComposite)
      type_of[words[i + 2]] = words[i + 1];
    if (op != spv::Op::OpSpecConstantOp || length != 6 ||
        spv::Op(words[i + 3]) != spv::Op::OpCompositeExtract)
      continue;
    const auto type = type_of.find(words[i + 4]);
    const auto count = type == type_of.end() ? components.end() : components.find(type->second);
    if (count != components.end() && words[i + 5] >= count->second)
      return fmt::format("word {}: component {} of a vector of {}\n", i, words[i + 5], count->second);
  }
  return {};
}

// Reports operands of execution modes that are no constants. The validator accepts them, and the optimiser
// crashes on them.
std::string modes_without_constants(const std::vector<uint32_t>& words) {
  std::set<uint32_t> constants;
  std::vector<std::span<const uint32_t>> modes;
  for_each_instruction(words, [&](spv::Op op, std::span<const uint32_t> w) {
    using enum spv::Op;
    if ((op == OpConstant || op == OpSpecConstant || op == OpSpecConstantOp) && w.size() > 3)
      constants.insert(w[2]);
    if (op == OpExecutionModeId && w.size() > 3) modes.push_back(w.subspan(3));
  });
  for (const std::span<const uint32_t> operands : modes)
    for (const uint32_t id : operands)
      if (!constants.contains(id))
        return fmt::format("operand %{} of an execution mode is no constant\n", id);
  return {};
}

// Returns what the validator does not see.
std::string missed_mistakes(const std::vector<uint32_t>& words) {
  const std::string components = missing_components(words);
  return components.empty() ? modes_without_constants(words) : components;
}

bool is_one_per_entry_point(spv::StorageClass storage) {
  return storage == spv::StorageClass::IncomingRayPayloadKHR ||
         storage == spv::StorageClass::IncomingCallableDataKHR ||
         storage == spv::StorageClass::HitAttributeKHR;
}

// Reports the second variable of a storage class of which an entry point may have one. Younger validators
// report it, too. Source: Vulkan specification, VUID-StandaloneSpirv-IncomingRayPayloadKHR-04700,
// VUID-StandaloneSpirv-HitAttributeKHR-04702, VUID-StandaloneSpirv-IncomingCallableDataKHR-04706. The words
// are not validated yet.
std::string second_incoming(std::span<const uint32_t> words) {
  std::map<uint32_t, std::string> names;
  std::map<uint32_t, spv::StorageClass> storage_of;
  std::vector<std::span<const uint32_t>> entry_points;
  for (size_t at = kHeaderWords, length = 0; at < words.size(); at += length) {
    length = words[at] >> 16;
    const spv::Op op = op_of(words[at]);
    if (length == 0 || length > words.size() - at || op == spv::Op::OpFunction) break;
    if (length < 4) continue;
    if (op == spv::Op::OpEntryPoint) entry_points.push_back(words.subspan(at, length));
    if (op == spv::Op::OpName) names[words[at + 1]] = text_at(words.subspan(at + 2, length - 2));
    if (op == spv::Op::OpVariable) storage_of[words[at + 2]] = spv::StorageClass(words[at + 3]);
  }
  const auto name_of = [&](uint32_t id) {
    const auto it = names.find(id);
    return it == names.end() ? fmt::format("%{}", id) : fmt::format("'{}'", it->second);
  };
  for (const std::span<const uint32_t> entry_point : entry_points) {
    const std::string name = text_at(entry_point.subspan(3));
    std::map<spv::StorageClass, uint32_t> first;
    for (size_t i = 3 + words_of(name).size(); i < entry_point.size(); ++i) {
      const auto it = storage_of.find(entry_point[i]);
      if (it == storage_of.end() || !is_one_per_entry_point(it->second)) continue;
      const auto [earlier, is_new] = first.emplace(it->second, it->first);
      if (!is_new && earlier->second != it->first)
        return fmt::format(
            "entry point '{}' has two variables of storage class {}, {} and {}, and Vulkan allows one\n",
            name, name_of_storage_class(uint32_t(it->second)), name_of(earlier->second), name_of(it->first));
    }
  }
  return {};
}

enum class IdNames { Numbers, Friendly };

// Returns what the validator says against the module, without false alarms; nothing when it says nothing.
std::string verdict(const std::vector<uint32_t>& words, IdNames names) {
  std::string messages;
  bool only_false_alarms = false;
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  tools.SetMessageConsumer(
      [&](spv_message_level_t level, const char*, const spv_position_t& at, const char* text) {
        if (level > SPV_MSG_ERROR) return;
        if (is_false_alarm(text))
          only_false_alarms = true;
        else
          messages += fmt::format("word {}: {}\n", at.index, text);
      });
  spvtools::ValidatorOptions options;
  options.SetScalarBlockLayout(true);
  options.SetWorkgroupScalarBlockLayout(true);
  options.SetFriendlyNames(names == IdNames::Friendly);
  if (tools.Validate(words.data(), words.size(), options)) return missed_mistakes(words);
  if (messages.empty() && only_false_alarms) return {};
  return messages.empty() ? "the SPIR-V validator rejected the module without a message\n" : messages;
}

}  // namespace

std::string validate_spirv(const std::vector<uint32_t>& words) {
  if (std::string second = second_incoming(words); !second.empty()) return second;
  if (nesting_of(words) > kDeepestValidated) return missed_mistakes(words);
  // The validator makes its table of friendly names in time that grows with the square of the ids that share
  // a name; 3,000 functions with a parameter "x" take it 1.6 s. Only messages need the table.
  if (verdict(words, IdNames::Numbers).empty()) return {};
  return verdict(words, IdNames::Friendly);
}

std::string validate_made_spirv(const std::vector<uint32_t>& words) {
#ifndef GLINT_DCHECKS
  if (selections_and_loops_of(words) > kMostValidated) return missed_mistakes(words);
#endif
  return validate_spirv(words);
}

bool is_spirv_file(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  return ending == ".spv" || ending == ".spvasm";
}

namespace {

std::vector<uint32_t> read_words(const std::string& path) {
  const std::optional<std::string> file = read_regular_file(path);
  if (!file) throw UserError({path, 0, 0}, "cannot read the shader");
  const std::string& bytes = *file;
  std::vector<uint32_t> words(bytes.size() / 4);
  if (std::filesystem::path(path).extension() == ".spvasm") {
    words = assemble_spirv(bytes, path);
  } else if (bytes.size() % 4 != 0) {
    throw UserError({path, 0, 0}, "not a SPIR-V module: it does not consist of words");
  } else {
    std::memcpy(words.data(), bytes.data(), bytes.size());
  }
  words = with_known_words(std::move(words));
  refuse_unknown_capabilities(words, path);
  check_limits(words, path, kDeepestValidated);
  const std::string invalid = validate_spirv(words);
  if (!invalid.empty()) throw UserError({path, 0, 0}, "invalid SPIR-V\n" + invalid);
  return words;
}

}  // namespace

std::vector<uint32_t> read_spirv(const std::string& path) {
  return with_deep_stack([&] { return read_words(path); });
}

namespace {

bool assemble_as(spv_target_env version, const std::string& text, std::vector<uint32_t>* words,
                 SourceLocation* where, std::string* message) {
  spvtools::SpirvTools tools(version);
  tools.SetMessageConsumer(
      [&](spv_message_level_t level, const char*, const spv_position_t& at, const char* said) {
        if (level <= SPV_MSG_ERROR)
          *message = said, where->line = int(at.line) + 1, where->column = int(at.column) + 1;
      });
  return tools.Assemble(text, words, SPV_TEXT_TO_BINARY_OPTION_PRESERVE_NUMERIC_IDS);
}

}  // namespace

std::vector<uint32_t> assemble_spirv(const std::string& text, const std::string& name) {
  // Choice: text gets the newest version in which it is valid, because its own version stands at most in a
  // comment. Version 1.6 dropped BufferBlock, 1.4 put all variables into the interface, and 1.0 is what tools
  // write without an option.
  std::vector<uint32_t> newest;
  for (const spv_target_env version : {SPV_ENV_VULKAN_1_3, SPV_ENV_UNIVERSAL_1_3, SPV_ENV_UNIVERSAL_1_0}) {
    SourceLocation where{name, 0, 0};
    std::string message = "cannot be assembled";
    std::vector<uint32_t> words;
    const bool done = assemble_as(version, text, &words, &where, &message);
    if (!done && newest.empty())
      throw UserError(
          where, message,
          message.starts_with("Invalid ")
              ? "the installed SPIRV-Tools do not know this name: it is misspelled, or younger than they are"
              : "");
    if (done) check_limits(words, name, kDeepestValidated);
    if (done && validate_spirv(words).empty()) return words;
    if (newest.empty()) newest = std::move(words);
  }
  return newest;  // The caller reports what is wrong with it.
}

std::string name_of_opcode(uint32_t opcode) {
  const char* name = spvOpcodeString(opcode);
  if (name == nullptr || std::string_view(name) == "unknown") return fmt::format("OpUnknown({})", opcode);
  return fmt::format("Op{}", name);
}

namespace {

// Returns the text of an instruction, disassembled after other instructions that it needs. SPIRV-Tools give
// names of enumerants only in text. The text is empty when the operands do not fit the op.
std::string text_of(spv::Op op, const std::vector<uint32_t>& operands,
                    const std::vector<uint32_t>& before = {}) {
  // The header says version 1.6 and ids below 100.
  std::vector<uint32_t> words{spv::MagicNumber, 0x0001'0600, 0, 100, 0};
  words.insert(words.end(), before.begin(), before.end());
  words.push_back(uint32_t(operands.size() + 1) << 16 | uint32_t(op));
  words.insert(words.end(), operands.begin(), operands.end());
  std::string text;
  const spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  return tools.Disassemble(words, &text, SPV_BINARY_TO_TEXT_OPTION_NO_HEADER) ? text : std::string();
}

// Returns the word of `text` that follows `start`, or the number when there is none.
std::string word_after(const std::string& text, std::string_view start, uint32_t number) {
  const size_t at = text.find(start);
  if (at == std::string::npos) return fmt::format("{}", number);
  const size_t begin = at + start.size();
  return text.substr(begin, text.find_first_of(" \n", begin) - begin);
}

// Returns the name of a capability as SPIRV-Tools print it, or its number when they do not know it.
std::string word_of_capability(uint32_t capability) {
  return word_after(text_of(spv::Op::OpCapability, {capability}), "OpCapability ", capability);
}

// Replaces the vendor's suffix, because older SPIRV-Tools print the names of the vendor's extension from
// which the ray-tracing extension grew.
std::string with_khr(std::string name) {
  if (name.ends_with("NV")) name.replace(name.size() - 2, 2, "KHR");
  return name;
}

}  // namespace

std::string name_of_capability(uint32_t capability) {
  const std::string_view newer = newer_capability(capability);
  return newer.empty() ? word_of_capability(capability) : std::string(newer);
}

void refuse_unknown_capabilities(const std::vector<uint32_t>& words, const std::string& name) {
  std::string unknown, extensions;
  for (size_t at = kHeaderWords; at < words.size() && words[at] >> 16 != 0; at += words[at] >> 16) {
    const auto op = spv::Op(words[at] & 0xffff);
    if (op == spv::Op::OpFunction) break;
    if (op == spv::Op::OpExtension)
      extensions += fmt::format(" {}", reinterpret_cast<const char*>(&words[at + 1]));
    if (op != spv::Op::OpCapability || at + 1 == words.size()) continue;
    if (word_of_capability(words[at + 1]) == fmt::format("{}", words[at + 1]))
      unknown += fmt::format("\n  {}: capability {}, which the installed SPIRV-Tools do not know", name,
                             name_of_capability(words[at + 1]));
  }
  if (!unknown.empty())
    throw UnsupportedError(
        fmt::format("{}: not supported:{}\n  extensions of the module:{}", name, unknown, extensions));
}

std::string name_of_storage_class(uint32_t storage) {
  return with_khr(word_after(text_of(spv::Op::OpVariable, {1, 2, storage}), "OpVariable %1 ", storage));
}

std::string name_of_builtin(uint32_t builtin) {
  const auto decoration = uint32_t(spv::Decoration::BuiltIn);
  return with_khr(word_after(text_of(spv::Op::OpDecorate, {1, decoration, builtin}), "BuiltIn ", builtin));
}

std::string name_of_execution_model(uint32_t model) {
  return with_khr(word_after(text_of(spv::Op::OpEntryPoint, {model, 1, 0}), "OpEntryPoint ", model));
}

std::string name_of_glsl_function(uint32_t function) {
  // These are the words of: %1 = OpExtInstImport "GLSL.std.450"
  const std::vector<uint32_t> import{
      6u << 16 | uint32_t(spv::Op::OpExtInstImport), 1, 0x4c53'4c47, 0x6474'732e, 0x3035'342e, 0};
  std::string text;
  std::vector<uint32_t> operands{2, 3, 1, function};
  for (int arguments = 0; arguments < 4 && text.empty(); ++arguments) {
    text = text_of(spv::Op::OpExtInst, operands, import);
    operands.push_back(4);
  }
  return "GLSL.std.450 " + word_after(text, "OpExtInst %2 %1 ", function);
}

std::string disassemble_spirv(const std::vector<uint32_t>& words) {
  std::string text;
  const spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  const uint32_t options = SPV_BINARY_TO_TEXT_OPTION_INDENT | SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES;
  if (!tools.Disassemble(words, &text, options))
    throw UserError("error: not a SPIR-V module: it cannot be disassembled");
  return text;
}

}  // namespace glint::frontend
