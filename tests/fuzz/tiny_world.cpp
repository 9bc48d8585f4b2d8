// Defines the tiny world's memory, structures and driver shader.
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/tiny_world.h"

#include <array>
#include <cstring>
#include <vector>

#include "base/diagnostics.h"
#include "isa/text.h"
#include "pipeline/functional_machine.h"
#include "rtunit/structure/build.h"

namespace glint::fuzz {
namespace {

constexpr uint32_t kLaunchWidth = 40;  // a full warp and a partial warp
constexpr uint32_t kBufferBytes = 1024;
constexpr uint32_t kDriverBytes = 192;  // payload, then two attribute buffers
constexpr uint32_t kMaxTraceDepth = 2;

// The ray of each lane passes through the triangle, the box, both or neither.
constexpr const char* kDriver = R"(.program "driver"
.stage ray_generation
.registers 12
.local_bytes 192
    cvt.rn.f32.u32 %r1, %launch.x;
    mul.rn.f32 %r1, %r1, 0f3DCCCCCD;
    add.u32 %r4, %r0, 64;
    mov.b32 %r5, %r0;
    ld.const.b64 %rd2, [0];
    add.u32 %r0, %r0, 192;
    rt.trace %p0, %rd2, 0, 255, 0, 0, 0, %r1, 0f3E800000, 0fC0400000, 0f3C23D70A, 0, 0, 0f3F800000, 0f42C80000, %r5, %r4;
    ssy DONE;
LOOP:
    @!%p0 bra DONE;
    call.sbt.candidate;
    rt.resume %p0;
    bra LOOP;
DONE:
    join;
    call.sbt.hit;
    rt.end;
    sub.u32 %r0, %r0, 192;
    exit;
)";

struct Scene {
  mem::AddressSpace memory;
  rt::StructureInfo top;
  Address buffer = 0, binding_table = 0;
  std::vector<std::vector<std::byte>> pristine;  // contents of each allocation before a run

  Scene() {
    const float corners[] = {0, 0, 0, 2, 0, 0, 0, 2, 0};
    rt::BottomLevel triangle, box;
    rt::Geometry geometry;
    geometry.positions = std::as_bytes(std::span(corners));
    geometry.opaque = false;
    triangle.geometries.push_back(geometry);
    const std::vector<rt::Bounds> bounds{{{1, 0, 1}, {3, 1, 2}}};
    geometry = {};
    geometry.aabbs = bounds;
    geometry.opaque = false;
    box.geometries.push_back(geometry);
    const std::vector<rt::StructureInfo> bottoms{rt::build_bottom(memory, "triangle", triangle),
                                                 rt::build_bottom(memory, "box", box)};
    const std::vector<rt::Instance> instances{{rt::kIdentity, 7, 0xff, 0, 0, 0},
                                              {rt::kIdentity, 8, 0xff, 0, 0, 1}};
    top = rt::build_top(memory, "top", instances, bottoms);
    buffer = memory.allocate("buffer", kBufferBytes);
    binding_table = memory.allocate("binding table", 32 * 4);
    for (const auto& slot : memory.slots()) pristine.emplace_back(slot.data, slot.data + slot.bytes);
  }
  void restore() {
    const auto all = memory.slots();
    for (size_t i = 0; i < all.size(); ++i)
      if (!pristine[i].empty()) std::memcpy(all[i].data, pristine[i].data(), pristine[i].size());
  }
};

void bind(exec::World& world, uint32_t binding, uint64_t address, uint64_t bytes) {
  const uint64_t descriptor[2] = {address, bytes};
  std::memcpy(world.constant_bank.data() + binding * isa::kDescriptorBytes, descriptor, sizeof(descriptor));
}

}  // namespace

bool can_run(const isa::Program& program) {
  return program.shared_bytes <= 48 * 1024 && program.local_bytes <= 64 * 1024;
}

std::string run(const isa::Program& program, uint64_t max_instructions) {
  static Scene scene;
  static const isa::Program driver = isa::parse(kDriver, "driver");
  scene.restore();
  const bool is_entry = program.stage == isa::Stage::RayGeneration || program.stage == isa::Stage::Compute;
  exec::World world;
  const exec::Image image = exec::link({is_entry ? program : driver, program});
  world.image = &image;
  world.memory = &scene.memory;
  world.constant_bank.resize(isa::kConstantBankBytes);
  bind(world, 0, scene.top.address, scene.top.bytes);
  bind(world, 1, scene.buffer, kBufferBytes);
  bind(world, 2, 0, 1);
  std::memcpy(world.constant_bank.data() + isa::kPushConstantOffset, &scene.buffer, 8);
  world.images.push_back({});
  world.images[0].width = world.images[0].height = 4;
  world.images[0].base = scene.buffer;
  world.images[0].name = "image";
  world.raygen = 0;
  const auto only = [&](isa::Stage stage) { return program.stage == stage ? 1u : exec::kNoShader; };
  world.miss = {only(isa::Stage::Miss)};
  world.hit = {{only(isa::Stage::ClosestHit), only(isa::Stage::AnyHit), only(isa::Stage::Intersection)}};
  world.callable = {only(isa::Stage::Callable)};
  world.max_callable_depth = kMaxTraceDepth;
  exec::place_plain_table(world, scene.binding_table);
  world.launch_size = {kLaunchWidth, 1, 1};
  world.local_bytes = (kDriverBytes + kMaxTraceDepth * (program.local_bytes + 16) + 15) / 16 * 16;
  world.max_trace_depth = kMaxTraceDepth;
  try {
    pipeline::run_functional(world, max_instructions, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace glint::fuzz
