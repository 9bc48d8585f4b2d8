// Tests mistakes with buffers, addresses, shared and local memory, descriptors and images.
// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/faults.h"
#include "tests/shaders/compute_lab.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

using Catch::Contains;
using exec::FaultKind;

constexpr uint32_t kThreads = 64, kWords = 40;  // two blocks; elements of `data`: word i is 100 + i
const std::string kPlace = "glsl/faults/memory.comp:21";

std::vector<uint32_t> run_wrong(const std::string& code, const LabOptions& options, exec::FaultLog& faults) {
  ComputeLab lab("faults/memory.comp");
  lab.grid = {kThreads / 32, 1, 1};
  lab.buffers[0] = Words(kThreads);
  lab.buffers[1] = Words(kWords);
  for (uint32_t i = 0; i < kWords; ++i) lab.buffers[1][i] = 100 + i;
  lab.buffer_arrays[2] = {Words{1}, Words{2}};
  for (const uint32_t binding : {3u, 4u}) {
    LabImage image;
    image.view.format = exec::TexelFormat::R32Uint;
    image.view.width = image.view.height = 4;
    image.texels.assign(16, 5);
    lab.images[binding] = {image};
  }
  lab.addressed = {1};
  lab.glsl.defines = {{"WRONG", code}};
  lab.run(options);
  faults = lab.faults;
  return lab.buffers[0];
}

void check_memory(const Mistake& mistake) {
  check_mistake(mistake, kPlace, run_wrong);
}

uint32_t data_or_zero(uint32_t lane) {
  return lane < kWords ? 100 + lane : 0;
}

}  // namespace

TEST_CASE("a load past the end of a buffer names the buffer and the distance, and gives 0 when let pass") {
  check_memory(
      {"got = data[i];", "reads 4 bytes at 0x", FaultKind::OutOfBounds, 24, {40, 0, 0}, data_or_zero});
  check_memory({"got = data[i];",
                ": 0 bytes past the end of 'binding 1' (160 bytes)",
                FaultKind::OutOfBounds,
                24,
                {40, 0, 0},
                data_or_zero});
}

TEST_CASE("a store past the end of a buffer is dropped when let pass, those inside are not") {
  check_memory({"data[i + 8u] = i; memoryBarrierBuffer(); barrier(); got = i < 32u ? data[i + 8u] : 1u;",
                "writes 4 bytes at 0x",
                FaultKind::OutOfBounds,
                32,
                {32, 0, 0},
                [](uint32_t lane) { return lane < 32 ? lane : 1; }});
}

TEST_CASE("an atomic outside of a buffer answers 0 and changes nothing when let pass") {
  check_memory({"got = atomicAdd(data[i], 1u);",
                "changes 4 bytes at 0x",
                FaultKind::OutOfBounds,
                24,
                {40, 0, 0},
                data_or_zero});
}

TEST_CASE("an index past an array in shared memory names the block's shared memory") {
  check_memory({"got = words[i % 32u];",
                "0 bytes past the end of the block's shared memory (64 bytes)",
                FaultKind::OutOfBounds,
                32,
                {16, 0, 0},
                [](uint32_t lane) { return lane % 32 < 16 ? lane % 32 : 0; }});
  check_memory({"words[i % 32u] = 3u; barrier(); got = words[i % 16u];",
                "writes 4 bytes at shared address 0x40",
                FaultKind::OutOfBounds,
                32,
                {16, 0, 0},
                [](uint32_t) { return 3; }});
}

TEST_CASE("an index that leaves the lane's stack is let pass, the stack's size is told") {
  check_memory({"uint own[4] = uint[4](1u, 2u, 3u, 4u); got = own[i == 9u ? 1000000u : i % 4u];",
                "the stack of a lane has 16 bytes",
                FaultKind::OutOfBounds,
                1,
                {9, 0, 0},
                [](uint32_t lane) { return lane == 9 ? 0 : lane % 4 + 1; }});
}

TEST_CASE("a misaligned address names where it lies, and is rounded down when let pass") {
  check_memory({"got = Word(data_address + uint64_t(i == 5u ? 10u : 4u)).value;",
                "which is not a multiple of 4: byte 10 of 'binding 1' (160 bytes)",
                FaultKind::Misaligned,
                1,
                {5, 0, 0},
                [](uint32_t lane) { return lane == 5 ? 102 : 101; }});
}

TEST_CASE("an address that was never set is called a null pointer") {
  check_memory({"got = Word(i == 33u ? uint64_t(0) : data_address).value;",
                "a null pointer plus 0 bytes: nothing is bound there",
                FaultKind::OutOfBounds,
                1,
                {33, 0, 0},
                [](uint32_t lane) { return lane == 33 ? 0 : 100; }});
}

TEST_CASE("an address before the first byte of a buffer says how far before") {
  check_memory({"got = Word(data_address - uint64_t(i == 2u ? 8u : 0u)).value;",
                ": 8 bytes before the start of 'binding 1' (160 bytes)",
                FaultKind::OutOfBounds,
                1,
                {2, 0, 0},
                [](uint32_t lane) { return lane == 2 ? 0 : 100; }});
}

TEST_CASE("a descriptor past its array is read as 0, and what is read through it as well") {
  check_memory({"got = elements[nonuniformEXT(i % 4u)].data[0];",
                "past the end of 'table 2' (32 bytes)",
                FaultKind::OutOfBounds,
                32,
                {2, 0, 0},
                [](uint32_t lane) { return lane % 4 == 0   ? 1
                                           : lane % 4 == 1 ? 2
                                                           : 0; }});
}

TEST_CASE(
    "texels outside of an image are 0 and stores there dropped when let pass; the message has coordinates "
    "and size") {
  check_memory({"got = imageLoad(picture, ivec2(i % 8u, 0)).x;",
                "reads texel (4, 0, 0) of layer 0, level 0, of image 'image 3', which is 4x4x1",
                FaultKind::Image,
                32,
                {4, 0, 0},
                [](uint32_t lane) { return lane % 8 < 4 ? 5 : 0; }});
  check_memory(
      {"imageStore(picture, ivec2(0, i % 8u), uvec4(9u)); barrier(); got = imageLoad(picture, ivec2(0, i % "
       "4u)).x;",
       "writes texel (0, 4, 0)",
       FaultKind::Image,
       32,
       {4, 0, 0},
       [](uint32_t) { return 9; }});
  check_memory({"got = texelFetch(sampled, ivec2(i % 8u, 0), 0).x;",
                "reads texel (4, 0, 0)",
                FaultKind::Image,
                32,
                {4, 0, 0},
                [](uint32_t lane) { return lane % 8 < 4 ? 5 : 0; }});
}

TEST_CASE("a ray query in what is not a structure names what lies there, and finds nothing when let pass") {
  check_memory(
      {"rayQueryEXT q; rayQueryInitializeEXT(q, accelerationStructureEXT(data_address + uint64_t(16u)), 0, "
       "0xff, vec3(0), 0.0, vec3(1), 9.0); "
       "got = rayQueryProceedEXT(q) ? 1u : 10u + rayQueryGetIntersectionTypeEXT(q, true);",
       "which is not a top-level acceleration structure: byte 16 of 'binding 1' (160 bytes)",
       FaultKind::Structure,
       64,
       {0, 0, 0},
       [](uint32_t) { return 10; }});
}

TEST_CASE("a ray query in a structure of an unknown node format says so, and finds nothing when let pass") {
  check_memory(
      {"data[0] = 0x53424c47u; data[1] = 1u; data[14] = 0x12345678u; memoryBarrierBuffer(); "
       "barrier(); rayQueryEXT q; rayQueryInitializeEXT(q, accelerationStructureEXT(data_address), 0, 0xff, "
       "vec3(0), 0.0, vec3(1), 9.0); "
       "got = rayQueryProceedEXT(q) ? 1u : 10u + rayQueryGetIntersectionTypeEXT(q, true);",
       "its header names the node format 0x12345678, which no policy of bvh.format has",
       FaultKind::Structure,
       64,
       {0, 0, 0},
       [](uint32_t) { return 10; }});
}

TEST_CASE("a part of a warp that comes to a barrier counts as the warp when let pass") {
  check_memory({"if ((i & 1u) == 1u) { data[i % 40u] = 7u; barrier(); } got = i;",
                "16 of the 32 lanes of the warp come to bar.sync, but all have to come together",
                FaultKind::Barrier,
                32,
                {1, 0, 0},
                [](uint32_t lane) { return lane; }});
}

TEST_CASE("a program without end stops also when faults are let pass, after those that were") {
  for (const bool timing : {false, true}) {
    const std::string message = fault_of("got = data[i]; while (data[0] != 0u) data[1] += 1u;",
                                         fault_options(timing, exec::OnFault::Warn), run_wrong);
    CHECK_THAT(message, Contains(timing ? "no end in sight: for 20000000 cycles no warp has begun or ended"
                                        : "no end in sight: the warp has executed more than") &&
                            Contains(kPlace));
    if (!timing) continue;
    CHECK_THAT(message, Contains("past the end of 'binding 1' (160 bytes)") &&
                            Contains("warning: faults let pass: 24, at 1 places"));
  }
}

}  // namespace glint::test
