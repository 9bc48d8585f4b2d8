// Holds GLSL extensions as macros and functions of the extensions that glslang 12 has, for a glslang that
// lacks them.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/glsl/newer_glsl.h"

#include <algorithm>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>

namespace glint::frontend {
namespace {

constexpr std::string_view kPrefix = "extension:";

// These are hints to the compiler, which it may ignore.
constexpr std::string_view kExpectAssume = R"(
#define expectEXT(value, expected) (value)
#define assumeEXT(condition) (condition)
)";
// For Glint the extension only adds the name of an attribute, and glslang skips attributes that it does not
// know.
constexpr std::string_view kMaximalReconvergence = R"(
#extension GL_EXT_subgroup_uniform_control_flow : enable
)";
constexpr std::string_view kNontemporal = R"(
#define nontemporal
)";
constexpr std::string_view kSubgroupRotate = R"(
#extension GL_KHR_shader_subgroup_basic : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
#define subgroupRotate(value, delta) subgroupShuffle(value, (gl_SubgroupInvocationID + uint(delta)) & (gl_SubgroupSize - 1u))
#define subgroupClusteredRotate(value, delta, size) subgroupShuffle(value, \
  (gl_SubgroupInvocationID & ~(uint(size) - 1u)) | ((gl_SubgroupInvocationID + uint(delta)) & (uint(size) - 1u)))
)";

// The sums are modulo 2^32. A saturating sum is the sum in 64 bits, clamped to 32.
constexpr std::string_view kDotProduct = R"(
#ifndef GLINT_DOT_PRODUCT
#define GLINT_DOT_PRODUCT
#define GLINT_DOT(type, scalar) \
  scalar dotEXT(type##2 a, type##2 b) { return a.x * b.x + a.y * b.y; } \
  scalar dotEXT(type##3 a, type##3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; } \
  scalar dotEXT(type##4 a, type##4 b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
GLINT_DOT(ivec, int)
GLINT_DOT(uvec, uint)
ivec4 glint_bytes(int x) { return ivec4(bitfieldExtract(x, 0, 8), bitfieldExtract(x, 8, 8), bitfieldExtract(x, 16, 8), x >> 24); }
ivec4 glint_bytes(uint x) { return ivec4(x & 255u, x >> 8 & 255u, x >> 16 & 255u, x >> 24); }
#define GLINT_DOT_PACKED(scalar, left, right) \
  scalar dotPacked4x8EXT(left a, right b) { return scalar(dotEXT(glint_bytes(a), glint_bytes(b))); }
GLINT_DOT_PACKED(int, int, int)
GLINT_DOT_PACKED(int, int, uint)
GLINT_DOT_PACKED(int, uint, int)
GLINT_DOT_PACKED(uint, uint, uint)
int glint_saturated(int a, int b) {
  int sum = a + b;
  return ((a ^ sum) & (b ^ sum)) < 0 ? (a < 0 ? -2147483647 - 1 : 2147483647) : sum;
}
int dotPacked4x8AccSatEXT(int a, int b, int c) { return glint_saturated(dotPacked4x8EXT(a, b), c); }
int dotPacked4x8AccSatEXT(int a, uint b, int c) { return glint_saturated(dotPacked4x8EXT(a, b), c); }
int dotPacked4x8AccSatEXT(uint a, int b, int c) { return glint_saturated(dotPacked4x8EXT(a, b), c); }
uint dotPacked4x8AccSatEXT(uint a, uint b, uint c) { uint sum = dotPacked4x8EXT(a, b); return sum > ~c ? ~0u : sum + c; }
#endif
)";

// Uses the numbers of SPV_KHR_ray_tracing_position_fetch. known_positions.h turns the result into SPIR-V that
// SPIRV-Tools know.
constexpr std::string_view kPositionsOfQueries = R"(
#extension GL_EXT_spirv_intrinsics : enable
#extension GL_EXT_ray_query : enable
#ifndef GLINT_QUERY_POSITIONS
#define GLINT_QUERY_POSITIONS
spirv_instruction(extensions = ["SPV_KHR_ray_tracing_position_fetch"], capabilities = [5391], id = 5340)
vec3[3] glint_positions_of(spirv_by_reference rayQueryEXT query, int intersection);
#define rayQueryGetIntersectionTriangleVertexPositionsEXT(query, committed, positions) positions = glint_positions_of(query, int(committed))
#endif
)";
// Holds what hit shaders get in addition to kPositionsOfQueries.
constexpr std::string_view kPositionsOfHits = R"(
#ifndef GLINT_HIT_POSITIONS
#define GLINT_HIT_POSITIONS
spirv_decorate(extensions = ["SPV_KHR_ray_tracing_position_fetch"], capabilities = [5336], 11, 5335) in vec3 glint_positions[3];
#define gl_HitTriangleVertexPositionsEXT glint_positions
#endif
)";

// Gives GL_NV_shader_invocation_reorder the names of its later multi-vendor extension. This holds for every
// glslang, because the lowering reads the vendor's instructions only.
constexpr std::string_view kInvocationReorder = R"(
#extension GL_NV_shader_invocation_reorder : enable
#define hitObjectEXT hitObjectNV
#define hitObjectAttributeEXT hitObjectAttributeNV
#define reorderThreadEXT reorderThreadNV
#define hitObjectTraceRayEXT hitObjectTraceRayNV
#define hitObjectTraceRayMotionEXT hitObjectTraceRayMotionNV
#define hitObjectRecordEmptyEXT hitObjectRecordEmptyNV
#define hitObjectRecordMissEXT(object, flags, index, origin, tmin, direction, tmax) hitObjectRecordMissNV(object, index, origin, tmin, direction, tmax)
#define hitObjectRecordMissMotionEXT(object, flags, index, origin, tmin, direction, tmax, time) \
  hitObjectRecordMissMotionNV(object, index, origin, tmin, direction, tmax, time)
#define hitObjectExecuteShaderEXT hitObjectExecuteShaderNV
#define hitObjectReorderExecuteEXT(object, payload) { reorderThreadNV(object); hitObjectExecuteShaderNV(object, payload); }
#define hitObjectTraceReorderExecuteEXT(object, structure, flags, mask, offset, stride, miss, origin, tmin, direction, tmax, payload) { \
  hitObjectTraceRayNV(object, structure, flags, mask, offset, stride, miss, origin, tmin, direction, tmax, payload); \
  reorderThreadNV(object); hitObjectExecuteShaderNV(object, payload); }
#define hitObjectIsEmptyEXT hitObjectIsEmptyNV
#define hitObjectIsMissEXT hitObjectIsMissNV
#define hitObjectIsHitEXT hitObjectIsHitNV
#define hitObjectGetRayTMinEXT hitObjectGetRayTMinNV
#define hitObjectGetRayTMaxEXT hitObjectGetRayTMaxNV
#define hitObjectGetWorldRayOriginEXT hitObjectGetWorldRayOriginNV
#define hitObjectGetWorldRayDirectionEXT hitObjectGetWorldRayDirectionNV
#define hitObjectGetObjectRayOriginEXT hitObjectGetObjectRayOriginNV
#define hitObjectGetObjectRayDirectionEXT hitObjectGetObjectRayDirectionNV
#define hitObjectGetObjectToWorldEXT hitObjectGetObjectToWorldNV
#define hitObjectGetWorldToObjectEXT hitObjectGetWorldToObjectNV
#define hitObjectGetInstanceCustomIndexEXT hitObjectGetInstanceCustomIndexNV
#define hitObjectGetInstanceIdEXT hitObjectGetInstanceIdNV
#define hitObjectGetGeometryIndexEXT hitObjectGetGeometryIndexNV
#define hitObjectGetPrimitiveIndexEXT hitObjectGetPrimitiveIndexNV
#define hitObjectGetHitKindEXT hitObjectGetHitKindNV
#define hitObjectGetAttributesEXT hitObjectGetAttributesNV
#define hitObjectGetShaderBindingTableRecordIndexEXT hitObjectGetShaderBindingTableRecordIndexNV
#define hitObjectGetShaderRecordBufferHandleEXT hitObjectGetShaderRecordBufferHandleNV
#define hitObjectGetCurrentTimeEXT hitObjectGetCurrentTimeNV
)";

struct Extension {
  std::string_view name, text, more_of_hit_shaders;
  bool is_always_ours = false;
};
constexpr Extension kExtensions[] = {
    {"GL_EXT_expect_assume", kExpectAssume, {}},
    {"GL_EXT_maximal_reconvergence", kMaximalReconvergence, {}},
    {"GL_EXT_nontemporal_keyword", kNontemporal, {}},
    {"GL_KHR_shader_subgroup_rotate", kSubgroupRotate, {}},
    {"GL_EXT_integer_dot_product", kDotProduct, {}},
    {"GL_EXT_ray_tracing_position_fetch", kPositionsOfQueries, kPositionsOfHits},
    {"GL_EXT_shader_invocation_reorder", kInvocationReorder, {}, true},
};

// Returns glslang's messages on a shader that asks for every extension of the table. glslang says "extension
// not supported" of those that it lacks. Its macros do not tell: glslang 15 defines none for some that it
// has.
std::string said_of_extensions() {
  std::string source = "#version 460\n";
  for (const Extension& each : kExtensions) source += "#extension " + std::string(each.name) + " : enable\n";
  source += "void main() {}\n";
  const char* const text = source.c_str();
  glslang::TShader shader(EShLangCompute);
  shader.setStrings(&text, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 460);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
  shader.parse(GetDefaultResources(), 460, false, EShMessages(EShMsgSpvRules | EShMsgVulkanRules));
  return shader.getInfoLog();
}

bool is_ours(const Extension& extension) {
  static const std::string said = said_of_extensions();  // thread-safe since C++11
  return extension.is_always_ours ||
         said.find("extension not supported: " + std::string(extension.name)) != std::string::npos;
}

constexpr std::string_view kBlanks = " \t";

// Takes `word` and the blanks before it from the start of `text`.
bool accept(std::string_view& text, std::string_view word) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

// Returns the extension of ours that a line enables.
std::string_view extension_named_by(std::string_view line) {
  if (!accept(line, "#") || !accept(line, "extension")) return {};
  for (const Extension& each : kExtensions) {
    std::string_view rest = line;
    if (accept(rest, each.name) && accept(rest, ":") && !accept(rest, "disable") && is_ours(each))
      return each.name;
  }
  return {};
}

}  // namespace

void say_extensions_anew(std::string& text) {
  if (text.find("extension") == std::string::npos) return;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view name = extension_named_by(std::string_view(text).substr(begin, end - begin));
    size_t length = end - begin;
    if (!name.empty()) {
      const std::string line = "#include \"" + std::string(kPrefix) + std::string(name) + "\"";
      text.replace(begin, length, line);
      length = line.size();
    }
    begin += length + 1;
  }
}

std::string text_of_extension(std::string_view header, isa::Stage stage) {
  if (!header.starts_with(kPrefix)) return {};
  header.remove_prefix(kPrefix.size());
  const auto* const found = std::find_if(std::begin(kExtensions), std::end(kExtensions),
                                         [&](const Extension& e) { return e.name == header; });
  if (found == std::end(kExtensions)) return {};
  const bool is_hit_shader = stage == isa::Stage::AnyHit || stage == isa::Stage::ClosestHit;
  return std::string(found->text) + std::string(is_hit_shader ? found->more_of_hit_shaders : "");
}

}  // namespace glint::frontend
