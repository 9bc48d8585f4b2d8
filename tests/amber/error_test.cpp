// Tests scripts that are wrong, and scripts that ask for what Glint lacks. Each error names its line.
// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include "tests/amber/support.h"
#include "tests/support/catch.h"

namespace glint::amber {
namespace {

const std::string kShader =
    "SHADER compute s GLSL\n#version 450\nlayout(binding = 0) buffer B { uint v[]; };\nvoid main() { v[9] = "
    "1; }\nEND\n"
    "BUFFER b DATA_TYPE uint32 DATA 1 2 END\n";
const std::string kPipeline =
    kShader + "PIPELINE compute p\n ATTACH s\n BIND BUFFER b AS storage DESCRIPTOR_SET 0 BINDING 0\nEND\n";

void check_all(const std::vector<std::pair<std::string, std::string>>& scripts, Verdict verdict, Exit exit) {
  for (const auto& [script, message] : scripts) {
    const Outcome outcome = outcome_of(script);
    INFO(script << "\n-> " << outcome.message);
    CHECK(outcome.verdict == verdict);
    CHECK(outcome.exit == exit);
    CHECK(contains(outcome.message, message));
    CHECK(outcome.message.rfind("t.amber", 0) == 0);
  }
}

TEST_CASE("a RUN of more threads than numbers of 32 bits is refused at its line", "[amber]") {
  check_all({{kPipeline + "RUN p 4294967295 4294967295 4294967295\n",
              "t.amber:12: error: a launch of 4294967295 x 4294967295 x 4294967295 blocks of 1 threads"},
             {kPipeline + "RUN p 65536 65536 1\n", "has more than 4294967295 threads"}},
            Verdict::Failed, Exit::UserInput);
}

TEST_CASE("a script that is wrong fails as bad input at the line of the mistake", "[amber]") {
  check_all(
      {{"BUFFER b\n", "t.amber:2: error: 'b' has no DATA_TYPE"},
       {"\nBUFFER b DATA_TYPE int31 SIZE 1 FILL 0\n", "t.amber:3: error: there is no data type 'int31'"},
       {"BUFFER b DATA_TYPE int32 DATA 1 x END\n", "value 1 of buffer 'b' is 'x'"},
       {"BUFFER b DATA_TYPE int32 DATA 1 2\n", "END is missing"},
       {"BUFFER b DATA_TYPE int32 SIZE 4294967295 FILL 0\n", "has more than"},
       {"BUFFER b DATA_TYPE int32 SIZE 1 SERIES_FROM 1\n", "INC_BY is missing"},
       {"BUFFER b DATA_TYPE int32 SIZE 1 FILL 0\nBUFFER b DATA_TYPE int32 SIZE 1 FILL 0\n",
        "t.amber:3: error: there is a buffer 'b' already"},
       {"SHADER compute s GLSL\nvoid main() {}\n", "t.amber:2: error: END is missing"},
       {"SHADER toast s GLSL\nEND\n", "there is no shader type 'toast'"},
       {"SHADER compute s BASIC\nEND\n", "there is no shader format 'BASIC'"},
       {"STRUCT s\nEND\n", "struct 's' has no members"},
       {"STRUCT s\n int32 a PADDING 3\nEND\n", "there is no attribute 'PADDING' of members"},
       {"STRUCT s STRIDE 4\n int32 a\n int32 b\nEND\nBUFFER b DATA_TYPE s SIZE 1 FILL 0\n",
        "the members of 's' are past its 4 bytes"},
       {"STRUCT s\n int32 a OFFSET 4294967292\nEND\nBUFFER b DATA_TYPE s SIZE 1 FILL 0\n",
        "t.amber:5: error:"},
       {"STRUCT s\n int32[16777216] a\nEND\nBUFFER b DATA_TYPE s SIZE 1 FILL 0\n",
        "has more than 1048576 numbers"},
       {"BUFFER b DATA_TYPE int32 WIDTH 4 HEIGHT 4 SIZE 3 FILL 0\n", "'b' has 16 texels and SIZE 3"},
       {"IMAGE i DATA_TYPE float WIDTH 2 HEIGHT 2 FILL 0\n", "has no DIM_1D"},
       {"SAMPLER s MAG_FILTER cubic\n", "there is no filter 'cubic'"},
       {"PIPELINE compute p\n ATTACH s\nEND\n", "t.amber:3: error: there is no shader 's'"},
       {kShader + "PIPELINE compute p\n BIND BUFFER c AS storage DESCRIPTOR_SET 0 BINDING 0\nEND\n",
        "there is no buffer 'c'"},
       {kShader + "PIPELINE compute p\n BIND BUFFER b AS storage DESCRIPTOR_SET 99 BINDING 0\nEND\n",
        "the set is '99'"},
       {kShader + "PIPELINE compute p\n ATTACH s\n", "END is missing"},
       {kShader + "PIPELINE raytracing p\n ATTACH s\nEND\n", "not a shader for this kind of pipeline"},
       {kShader + "DERIVE_PIPELINE q FROM p\nEND\n", "there is no pipeline 'p'"},
       {kPipeline + "RUN p 1 1\n", "t.amber:12: error: the size is missing"},
       {kPipeline + "RUN p 1 1 1 1\n", "'1' does not belong here"},
       {kPipeline + "RUN q 1 1 1\n", "there is no pipeline 'q'"},
       {kShader + "EXPECT b IDX 0\n", "a comparison is missing"},
       {kShader + "EXPECT b IDX 0 EQ\n", "the values are missing"},
       {kShader + "EXPECT b IDX 8 EQ 1\n", "byte 8 is past the end of buffer 'b' (8 bytes)"},
       {kShader + "EXPECT b IDX 0 0 SIZE 1 1 EQ_RGB 1 2 3\n", "'b' has no width"},
       {kShader + "COPY b TO b\n", "cannot be copied to itself"},
       {kShader + "REPEAT 2\nCOPY b TO c\n", "there is no buffer 'c'"},
       {"ACCELERATION_STRUCTURE BOTTOM_LEVEL a\n GEOMETRY TRIANGLES\n 0 0 0 1 0 0\n END\nEND\n",
        "found 6 coordinates"},
       {"ACCELERATION_STRUCTURE TOP_LEVEL a\n BOTTOM_LEVEL_INSTANCE b\n END\nEND\n",
        "there is no bottom level 'b'"}},
      Verdict::Failed, Exit::UserInput);
}

TEST_CASE("a script that asks for what there is not is unsupported, by name and line", "[amber]") {
  check_all(
      {{"PIPELINE graphics p\nEND\n", "t.amber:2: unsupported: graphics pipelines"},
       {"SHADER vertex v PASSTHROUGH\n", "unsupported: graphics: vertex shaders"},
       {"SHADER compute c OPENCL-C\nEND\n", "unsupported: shaders in OPENCL-C"},
       {"SHADER compute c HLSL\nEND\n", "unsupported: shaders in HLSL"},
       {"DEVICE_FEATURE sparseBinding\n", "unsupported: DEVICE_FEATURE sparseBinding"},
       {"DEVICE_FEATURE Robustness2Features.nullDescriptor\n",
        "unsupported: DEVICE_FEATURE Robustness2Features.nullDescriptor"},
       {"DEVICE_PROPERTY FloatControls.shaderRoundingModeRTZFloat32\n", "unsupported: DEVICE_PROPERTY"},
       {"BUFFER b FORMAT D32_SFLOAT SIZE 1 FILL 0\n", "unsupported: format D32_SFLOAT"},
       {"IMAGE i FORMAT R64_SFLOAT DIM_2D WIDTH 1 HEIGHT 1 FILL 0\n", "unsupported: images of R64_SFLOAT"},
       {"IMAGE i FORMAT R8_UINT DIM_2D WIDTH 1 HEIGHT 1 SAMPLES 4 DATA 1 2 3 4 END\n",
        "unsupported: contents of images of several samples"},
       {kShader + "PIPELINE compute p\n SUBGROUP s\n  REQUIRED_SIZE 16\n END\nEND\n",
        "unsupported: SUBGROUP REQUIRED_SIZE 16"},
       {kShader + "PIPELINE compute p\n BIND BUFFER b KERNEL ARG_NAME x\nEND\n", "unsupported: OpenCL"},
       {kShader + "PIPELINE compute p\n SET KERNEL ARG_NAME x AS int32 3\nEND\n", "unsupported: OpenCL"},
       {kPipeline + "RUN p DRAW_RECT POS 0 0 SIZE 1 1\n", "unsupported: graphics: DRAW_RECT"},
       {"BUFFER b FORMAT R8G8B8A8_UNORM\n", "unsupported: graphics: buffers as large as a framebuffer"},
       {"CLEAR p\n", "unsupported: graphics: CLEAR"},
       {"SHADER compute s SPIRV-ASM TARGET_ENV spv9\nEND\nPIPELINE compute p\n ATTACH s\nEND\nRUN p 1 1 1\n",
        "unsupported: target environment 'spv9'"},
       {"SHADER compute s SPIRV-ASM\nOpCapability Telepathy\nEND\nPIPELINE compute p\n ATTACH s\nEND\nRUN p "
        "1 1 1\n",
        "t.amber:3:14: error: Invalid capability"},
       {"SHADER compute s SPIRV-ASM\nOpDream %1\nEND\nPIPELINE compute p\n ATTACH s\nEND\nRUN p 1 1 1\n",
        "unsupported: shader 's'"},
       {"SHADER compute s GLSL\n#version 450\n#extension GL_XX_none : require\nvoid main() {}\nEND\nPIPELINE "
        "compute p\n ATTACH s\nEND\nRUN p 1 1 1\n",
        "extension not supported: GL_XX_none"},
       {"DANCE\n", "unsupported: command DANCE"}},
      Verdict::Unsupported, Exit::Unsupported);
}

TEST_CASE("messages on GLSL count the lines of the script", "[amber]") {
  const Outcome outcome = outcome_of(
      "SHADER compute s GLSL\n#version 450\nvoid main() { oops(); }\nEND\nPIPELINE compute p\n ATTACH "
      "s\nEND\nRUN p 1 1 1\n");
  CHECK(outcome.exit == Exit::UserInput);
  CHECK(contains(outcome.message, "t.amber:4"));
}

TEST_CASE("messages on SPIR-V count the lines of the script", "[amber]") {
  const Outcome outcome = outcome_of(
      "SHADER compute s SPIRV-ASM\nOpCapability Shader\nOpTypeVoid\nEND\nPIPELINE compute p\n ATTACH "
      "s\nEND\nRUN p 1 1 1\n");
  CHECK(outcome.exit == Exit::UserInput);
  CHECK(contains(outcome.message, "t.amber:4"));
}

LaunchOptions strict(exec::OnFault on_fault = exec::OnFault::Stop) {
  LaunchOptions options;
  options.strict = true, options.on_fault = on_fault;
  return options;
}

TEST_CASE("in strict runs a store outside of a buffer fails with the lines of RUN and of the shader",
          "[amber]") {
  const Outcome outcome = outcome_of(kPipeline + "RUN p 1 1 1\n", strict());
  CHECK(outcome.exit == Exit::Fault);
  CHECK(contains(outcome.message, "t.amber:12"));
  CHECK(contains(outcome.message, "t.amber:5"));
}

TEST_CASE(
    "a store outside of a buffer is dropped and is no fault; in strict runs only where that is declared",
    "[amber]") {
  const std::string script = kPipeline + "RUN p 1 1 1\nEXPECT b IDX 0 EQ 1 2\n";
  for (const Outcome& outcome :
       {outcome_of(script), outcome_of("DEVICE_FEATURE robustBufferAccess\n" + script, strict()),
        outcome_of("DEVICE_FEATURE Robustness2Features.robustBufferAccess2\n" + script, strict())}) {
    CHECK(outcome.exit == Exit::Ok);
    CHECK(outcome.message == "");
    CHECK(outcome.faults.empty());
  }
}

TEST_CASE("shared memory and misaligned addresses are no matter of robust access", "[amber]") {
  const std::string script =
      "DEVICE_FEATURE robustBufferAccess\nSHADER compute s GLSL\n#version 450\nlayout(binding = 0) buffer B "
      "{ "
      "uint v[]; };\nshared uint s[4];\nvoid main() { s[v[0]] = 1; v[0] = s[v[1]]; }\nEND\n"
      "BUFFER b DATA_TYPE uint32 DATA 5000 1 END\nPIPELINE compute p\n ATTACH s\n BIND BUFFER b AS storage "
      "DESCRIPTOR_SET 0 BINDING 0\nEND\nRUN p 1 1 1\n";
  CHECK(contains(outcome_of(script).message, "the block's shared memory"));
}

TEST_CASE("indices that the optimiser cannot clamp make a script unsupported, with its reason", "[amber]") {
  const std::string script =
      "SHADER compute s GLSL\n#version 460\n#extension GL_EXT_buffer_reference : require\n"
      "layout(buffer_reference) buffer R { uint v[]; };\nlayout(binding = 0) buffer B { R r; };\n"
      "void main() { r.v[1] = 2; }\nEND\nBUFFER b DATA_TYPE uint32 DATA 1 2 END\nPIPELINE compute p\n ATTACH "
      "s\n SHADER_OPTIMIZATION s\n--graphics-robust-access\nEND\n BIND BUFFER b AS storage DESCRIPTOR_SET 0 "
      "BINDING 0\nEND\nRUN p 1 1 1\n";
  const Outcome outcome = outcome_of(script);
  CHECK(outcome.exit == Exit::Unsupported);
  CHECK(contains(outcome.message, "the indices of shader 's' cannot be clamped"));
  CHECK(contains(outcome.message, "ddressing"));
}

TEST_CASE("a fault that is let pass is told with the lines of RUN and of the shader", "[amber]") {
  const Outcome outcome = outcome_of(kPipeline + "RUN p 1 1 1\n", strict(exec::OnFault::Warn));
  CHECK(outcome.exit == Exit::Ok);
  REQUIRE(outcome.faults.size() == 1);
  CHECK(contains(outcome.faults[0], "t.amber:12: "));
  CHECK(contains(outcome.faults[0], "t.amber:5 "));
}

// Each entry declares a binding of one kind at set 1 binding 3 and uses it. Nothing is bound there.
const std::vector<std::pair<std::string, std::string>> kUnbound = {
    {"layout(set = 1, binding = 3) buffer U { uint u[]; };", "v[0] = u[1]"},
    {"layout(set = 1, binding = 3) uniform U { uint u; };", "v[0] = u"},
    {"layout(set = 1, binding = 3) buffer U { uint u[]; } us[2];", "v[0] = us[v[1] & 1].u[1]"},
    {"layout(set = 1, binding = 3, r32ui) uniform uimage2D u;", "v[0] = imageLoad(u, ivec2(0)).x"},
    {"layout(set = 1, binding = 3, r32ui) uniform uimage2D u;",
     "v[0] = 0; imageStore(u, ivec2(0), uvec4(7))"},
    {"layout(set = 1, binding = 3) uniform sampler2D u;", "v[0] = uint(textureLod(u, vec2(0), 0).x)"},
    {"layout(set = 1, binding = 3) uniform texture2D t;\nlayout(set = 0, binding = 9) uniform sampler s;",
     "v[0] = uint(textureLod(sampler2D(t, s), vec2(0), 0).x)"},
    {"layout(set = 0, binding = 9) uniform texture2D t;\nlayout(set = 1, binding = 3) uniform sampler s;",
     "v[0] = uint(textureLod(sampler2D(t, s), vec2(0), 0).x)"},
    {"layout(set = 1, binding = 3) uniform sampler2D u;", "v[0] = textureSize(u, 0).x"},
    {"layout(set = 1, binding = 70) uniform sampler2D w;\nlayout(set = 1, binding = 3) uniform "
     "usamplerBuffer u;",
     "v[0] = texelFetch(u, 0).x"},
    {"layout(set = 1, binding = 3) uniform accelerationStructureEXT u;",
     "rayQueryEXT q; rayQueryInitializeEXT(q, u, 0, 0xff, vec3(0), 0, vec3(1), 1); v[0] = "
     "rayQueryProceedEXT(q) ? 1 : 0"}};

std::string unbound_script(const std::string& declarations, const std::string& statement) {
  return "SHADER compute s GLSL\n#version 460\n#extension GL_EXT_ray_query : require\nlayout(binding = 0) "
         "buffer B { uint v[]; };\n" +
         declarations + "\nvoid main() { " + statement +
         "; }\nEND\nBUFFER b DATA_TYPE uint32 DATA 5 6 END\nIMAGE t FORMAT R32_SFLOAT DIM_2D WIDTH 1 HEIGHT "
         "1 FILL 3\n" +
         "SAMPLER s\nPIPELINE compute p\n ATTACH s\n BIND BUFFER b AS storage DESCRIPTOR_SET 0 BINDING 0\n" +
         (declarations.find("binding = 9) uniform sampler") != std::string::npos
              ? " BIND SAMPLER s DESCRIPTOR_SET 0 BINDING 9\n"
          : declarations.find("binding = 9) uniform texture") != std::string::npos
              ? " BIND BUFFER t AS sampled_image DESCRIPTOR_SET 0 BINDING 9\n"
              : "") +
         "END\nRUN p 1 1 1\nEXPECT b IDX 0 EQ 0\n";
}

TEST_CASE("the use of a binding that nobody bound is a fault that names set, binding, line and launch id",
          "[amber]") {
  for (const auto& [declarations, statement] : kUnbound)
    for (const bool is_strict : {false, true}) {
      const Outcome outcome =
          outcome_of(unbound_script(declarations, statement), is_strict ? strict() : LaunchOptions{});
      INFO(declarations << "\n-> " << outcome.message);
      CHECK(outcome.exit == Exit::Fault);
      CHECK(contains(outcome.message, "set 1 binding 3"));
      CHECK(contains(outcome.message, "to which nothing is bound"));
      CHECK(contains(outcome.message, "t.amber:"));
      CHECK(contains(outcome.message, "launch id (0, 0, 0)"));
    }
}

TEST_CASE("the use of a binding that nobody bound, let pass, reads 0 and writes nothing", "[amber]") {
  for (const auto& [declarations, statement] : kUnbound) {
    const Outcome outcome = outcome_of(unbound_script(declarations, statement), strict(exec::OnFault::Warn));
    INFO(declarations << "\n-> " << outcome.message);
    CHECK(outcome.exit == Exit::Ok);
    REQUIRE(!outcome.faults.empty());
    CHECK(contains(outcome.faults[0], "set 1 binding 3"));
  }
}

TEST_CASE("an element of an array of descriptors that nobody bound is a fault, too", "[amber]") {
  const std::string images =
      "SHADER compute s GLSL\n#version 460\nlayout(binding = 0) buffer B { uint v[]; };\n"
      "layout(binding = 1, r32ui) uniform uimage2D u[3];\nvoid main() { v[0] = imageLoad(u[v[1]], "
      "ivec2(0)).x; }\nEND\n"
      "IMAGE i FORMAT R32_UINT DIM_2D WIDTH 1 HEIGHT 1 FILL 3\n";
  const auto run = [&](const char* element) {
    return outcome_of(
        images + "BUFFER b DATA_TYPE uint32 DATA 9 " + element +
        " END\nPIPELINE compute p\n ATTACH s\n BIND BUFFER b AS storage DESCRIPTOR_SET 0 BINDING 0\n"
        " BIND BUFFER_ARRAY i AS storage_image DESCRIPTOR_SET 0 BINDING 1\nEND\nRUN p 1 1 1\nEXPECT b IDX 0 "
        "EQ 3\n");
  };
  CHECK(run("0").exit == Exit::Ok);
  CHECK(contains(run("2").message, "uses set 0 binding 1 (u), to which nothing is bound"));
}

TEST_CASE("in strict runs an access past the range of a descriptor is a fault though the buffer goes on",
          "[amber]") {
  const auto script = [](const char* bindings, const char* expected) {
    return std::string(
               "SHADER compute s GLSL\n#version 450\nlayout(binding = 0) buffer A { uint a[]; "
               "};\nlayout(binding = 1) buffer B { uint b[]; };\n"
               "void main() { a[0] = a.length(); b[0] = a[4]; }\nEND\nBUFFER x DATA_TYPE uint32 SIZE 128 "
               "SERIES_FROM 1 INC_BY 1\n"
               "PIPELINE compute p\n ATTACH s\n") +
           bindings + "END\nRUN p 1 1 1\n" + expected;
  };
  const std::string near = " BIND BUFFER x AS storage DESCRIPTOR_SET 0 BINDING 0 DESCRIPTOR_RANGE 16\n",
                    far = " BIND BUFFER x AS storage DESCRIPTOR_SET 0 BINDING 1 DESCRIPTOR_OFFSET 256\n";
  const Outcome outcome = outcome_of(script((near + far).c_str(), ""), strict());
  CHECK(outcome.exit == Exit::Fault);
  CHECK(contains(outcome.message, "0 bytes past the end of 'x, bytes 0 to 16' (16 bytes)"));
  const Outcome robust =
      outcome_of(script((near + far).c_str(), "EXPECT x IDX 0 EQ 4 2\nEXPECT x IDX 252 EQ 64 0 66\n"));
  CHECK(robust.message == "");
  CHECK(robust.exit == Exit::Ok);
  // The range ends where it ends, even where another descriptor names what follows, and both see the same
  // bytes.
  const std::string all = " BIND BUFFER x AS storage DESCRIPTOR_SET 0 BINDING 1\n";
  CHECK(outcome_of(script((near + all).c_str(), "EXPECT x IDX 0 EQ 0 2\n")).exit == Exit::Ok);
  const Outcome overlapping = outcome_of(script((near + all).c_str(), ""), strict());
  CHECK(overlapping.exit == Exit::Fault);
  CHECK(contains(overlapping.message, "0 bytes past the end of 'x, bytes 0 to 16' (16 bytes)"));
}

TEST_CASE("a buffer bound where the shader declares an image is an error of the script", "[amber]") {
  const Outcome outcome = outcome_of(
      "SHADER compute s GLSL\n#version 450\nlayout(binding = 0, r32ui) uniform uimage2D i;\nvoid main() { "
      "imageStore(i, ivec2(0), uvec4(1)); }\nEND\n"
      "BUFFER b DATA_TYPE uint32 DATA 1 2 END\nPIPELINE compute p\n ATTACH s\n BIND BUFFER b AS storage "
      "DESCRIPTOR_SET 0 BINDING 0\nEND\nRUN p 1 1 1\n");
  CHECK(outcome.exit == Exit::UserInput);
  CHECK(contains(outcome.message, "the shader declares the storage image 'i', but 'b' is not one"));
}

}  // namespace
}  // namespace glint::amber
