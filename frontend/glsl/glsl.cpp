// Compiles GLSL to SPIR-V 1.6 through glslang in process: includes, defines, debug lines, and messages with
// file and line.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <set>
#include <string_view>

#include "base/byte_stream.h"
#include "base/regular_file.h"
#include "frontend/cache.h"
#include "frontend/compile.h"
#include "frontend/deep_stack.h"
#include "frontend/glsl/includer.h"
#include "frontend/glsl/messages.h"
#include "frontend/glsl/newer_glsl.h"
#include "frontend/glsl/token_count.h"
#include "frontend/spirv/glslang_repairs.h"
#include "frontend/spirv/known_words.h"
#include "frontend/spirv/limits.h"
#include "frontend/spirv/spirv.h"

namespace glint::frontend {
namespace {

std::string key_of(const std::string& source, const std::string& path, isa::Stage stage,
                   const GlslOptions& options) {
  ByteWriter key;
  key.put(std::string("glsl"));
  key.put(path);
  key.put(stage);
  key.put(options.include_dirs);
  for (const auto& [name, value] : options.defines) key.put(name), key.put(value);
  key.put(source);
  return key.take();
}

// Returns the module that was stored for this source. It returns nothing when a file that the source
// included, or looked for without success, has changed since.
std::optional<std::vector<uint32_t>> find_words(ShaderCache& cache, const std::string& key) {
  const std::optional<std::string> bytes = cache.find(key);
  if (!bytes) return std::nullopt;
  ByteReader in(*bytes);
  const auto lookups = in.take<std::vector<Lookup>>();
  auto words = in.take<std::vector<uint32_t>>();
  return in.is_good() && are_unchanged(lookups) ? std::optional(std::move(words)) : std::nullopt;
}

void store(ShaderCache& cache, const std::string& key, const std::vector<Lookup>& lookups,
           const std::vector<uint32_t>& words) {
  ByteWriter out;
  out.put(lookups);
  out.put(words);
  cache.store(key, out.take());
}

// Owns glslang's tables, which live as long as the process: the first compilation makes them, and exit frees
// them.
struct Process {
  Process() { glslang::InitializeProcess(); }
  ~Process() { glslang::FinalizeProcess(); }
};

EShLanguage language_of(isa::Stage stage) {
  switch (stage) {
    case isa::Stage::RayGeneration:
      return EShLangRayGen;
    case isa::Stage::Intersection:
      return EShLangIntersect;
    case isa::Stage::AnyHit:
      return EShLangAnyHit;
    case isa::Stage::ClosestHit:
      return EShLangClosestHit;
    case isa::Stage::Miss:
      return EShLangMiss;
    case isa::Stage::Callable:
      return EShLangCallable;
    case isa::Stage::Compute:
      return EShLangCompute;
  }
  return EShLangCompute;
}

std::string preamble(const GlslOptions& options) {
  std::string text = "#extension GL_GOOGLE_include_directive : require\n";
  for (const auto& [name, value] : options.defines) text += fmt::format("#define {} {}\n", name, value);
  return text;
}

// Adds a text and the files that it includes, each once.
void add_tokens(TokenCount& count, Includer& includer, std::set<std::string>& known, const std::string& name,
                std::string_view text, size_t depth) {
  if (!known.insert(name).second) return;
  for (const TokenCount::Header& header : count.add(name, text)) {
    Includer::IncludeResult* found =
        header.is_local ? includer.includeLocal(header.name.c_str(), name.c_str(), depth) : nullptr;
    if (!found) found = includer.includeSystem(header.name.c_str(), name.c_str(), depth);
    if (!found) continue;
    if (!found->headerName.empty())
      add_tokens(count, includer, known, found->headerName, {found->headerData, found->headerLength},
                 depth + 1);
    includer.releaseInclude(found);
  }
}

// Refuses a shader that glslang would take too long to read. glslang expands macros without a limit.
void check_tokens(const std::string& source, const std::string& before, const std::string& path,
                  isa::Stage stage, const GlslOptions& options) {
  TokenCount count;
  Includer includer(options.include_dirs, stage, path);
  std::set<std::string> known;
  count.add(path, before);
  add_tokens(count, includer, known, path, source, 1);
  count.check();
}

constexpr int kDefaultGlslVersion = 460;  // the version that GL_EXT_ray_tracing needs

std::vector<uint32_t> generate(glslang::TShader& shader, EShLanguage language, EShMessages messages,
                               const std::string& path, const GlslOptions& glsl) {
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(messages)) throw_messages(program.getInfoLog(), {path, {}, glsl}, nullptr);
  glslang::SpvOptions options;
  options.generateDebugInfo = true;
  options.disableOptimizer = true;
  options.validate = false;  // It is validated below, with scalar block layout.
  std::vector<uint32_t> words;
  spv::SpvBuildLogger log;
  glslang::GlslangToSpv(*program.getIntermediate(language), words, &log, &options);
  words = with_known_words(std::move(words));
  refuse_unknown_capabilities(words, path);
  check_limits(words, path);
  std::string invalid = validate_made_spirv(words);
  if (!invalid.empty()) {
    words = with_glslang_repairs(words);
    invalid = validate_made_spirv(words);
  }
  if (!invalid.empty()) throw UserError({path, 0, 0}, "glslang made invalid SPIR-V\n" + invalid);
  return words;
}

}  // namespace

std::vector<uint32_t> glsl_to_spirv(const std::string& path, const GlslOptions& options) {
  const std::optional<isa::Stage> stage = stage_of_file(path);
  if (!stage)
    throw UserError(
        {path, 0, 0}, "unknown shader stage",
        path.ends_with(".ptx")
            ? "`glint init FILE.toml KERNEL.ptx` writes a launch of a PTX kernel, and `glint run FILE.toml` "
              "runs it"
            : "name the file .rgen, .rint, .rahit, .rchit, .rmiss, .rcall or .comp, or add .glsl to that");
  const std::optional<std::string> source = read_regular_file(path);
  if (!source) throw UserError({path, 0, 0}, "cannot read the shader");
  return glsl_text_to_spirv(*source, path, *stage, options);
}

namespace {

std::vector<uint32_t> text_to_spirv(const std::string& source, const std::string& path, isa::Stage stage,
                                    const GlslOptions& options) {
  const std::string key = options.cache ? key_of(source, path, stage, options) : std::string();
  if (options.cache)
    if (std::optional<std::vector<uint32_t>> found = find_words(*options.cache, key))
      return std::move(*found);
  refuse_old_version({path, source, options});
  static const Process process;  // thread-safe since C++11
  const EShLanguage language = language_of(stage);
  glslang::TShader shader(language);
  std::string main = source;
  say_extensions_anew(main);
  const char* text = main.c_str();
  const int length = int(main.size());
  const char* name = path.c_str();
  shader.setStringsWithLengthsAndNames(&text, &length, &name, 1);
  const std::string before = preamble(options);
  check_tokens(source, before, path, stage, options);
  shader.setPreamble(before.c_str());
  shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, kDefaultGlslVersion);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
  // setDebugInfo(true) is not used: with it, glslang 12 opens a debug scope for each block from a set that it
  // does not import.
  shader.setEnhancedMsgs();
  const auto messages = EShMessages(EShMsgSpvRules | EShMsgVulkanRules | EShMsgDebugInfo | EShMsgEnhanced);
  Includer includer(options.include_dirs, stage, path);
  if (!shader.parse(GetDefaultResources(), kDefaultGlslVersion, ENoProfile, false, false, messages, includer))
    throw_messages(shader.getInfoLog(), {path, source, options}, &includer);
  std::vector<uint32_t> words = generate(shader, language, messages, path, options);
  if (options.cache) store(*options.cache, key, includer.lookups(), words);
  return words;
}

}  // namespace

std::vector<uint32_t> glsl_text_to_spirv(const std::string& source, const std::string& path, isa::Stage stage,
                                         const GlslOptions& options) {
  return with_deep_stack([&] { return text_to_spirv(source, path, stage, options); });
}

}  // namespace glint::frontend
