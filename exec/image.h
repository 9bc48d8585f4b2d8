// Links all shaders of a pipeline into one code image, and holds the world in which warps execute it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "exec/fault.h"
#include "exec/image_view.h"
#include "exec/print_log.h"
#include "exec/traversal_record.h"
#include "exec/warp_layout.h"
#include "isa/barrier.h"
#include "isa/message.h"
#include "isa/op_row.h"
#include "isa/program.h"
#include "isa/text.h"
#include "memsys/address_space.h"
#include "rtunit/any_hit_mode.h"
#include "rtunit/leaf_filter.h"

namespace glint::exec {

inline constexpr uint32_t kNoShader = 0xffff'ffff;

// Describes one linked shader, and where its code lies in Image::code.
struct Shader {
  std::string name;
  isa::Stage stage = isa::Stage::Compute;
  uint32_t entry = 0, end = 0;  // instruction indices [entry, end)
  uint32_t local_bytes = 0;
  isa::SpecialSet specials_used;
  std::vector<isa::ParsedMessage> messages;  // messages of print and print.part, by number
  // They say whether the shader reads %payload or a special after it, and %object.origin or a special after
  // it.
  bool uses_ray = false, uses_matrices = false;
};

// Frees rows of 32 lanes. They are aligned to cache lines, as the handlers' vector loads need, and not
// initialised.
struct FreeRows {
  void operator()(uint32_t* rows) const { std::free(rows); }
};
using Rows = std::unique_ptr<uint32_t[], FreeRows>;
inline Rows allocate_rows(size_t count) {
  return Rows(static_cast<uint32_t*>(std::aligned_alloc(64, std::max<size_t>(count, 1) * sizeof(isa::Row))));
}

// Holds an instruction, and what executing it needs of its row, in one cache line of the host.
struct alignas(64) Step {
  Step(const isa::Inst& instruction, const isa::OpRow& its_row)
      : inst(instruction),
        effect(its_row.effect),
        meets(its_row.effect == isa::Effect::Barrier || isa::has_lane_mask(its_row)),
        row(&its_row),
        run(its_row.run) {
    is_value = its_row.effect == isa::Effect::None && !meets;
  }

  isa::Inst inst;
  isa::Effect effect;               // OpRow::effect
  bool is_value = false;            // It does nothing but compute values of its own lanes.
  bool target_is_join : 1 = false;  // It is a branch that goes to a `join`.
  bool may_wait : 1 = false;  // It jumps back in a loop in which lanes may wait for others of their warp.
  bool meets : 1;             // Lanes that have parted come together here (Control::meet).
  const isa::OpRow* row;      // op_table()[inst.op]
  isa::Handler run;           // OpRow::run
};
static_assert(sizeof(Step) == 64);

// Holds the code of all shaders, with absolute branch targets and constants in one table of 32-lane rows.
struct Image {
  std::vector<Step> code;
  std::vector<isa::Line> lines;  // one per instruction; file indexes Image::files
  std::vector<std::string> files;
  std::vector<uint32_t> shader_of;  // one per instruction
  std::vector<Shader> shaders;
  // By number of a function (isa::Program::function): the index in `shaders`, or kNoShader.
  std::vector<uint32_t> functions;
  std::vector<isa::Program> programs;  // one per shader, as they were compiled; for listings
  Rows constants;
  uint32_t num_registers = 1;  // the highest of all shaders
  // These are the rows of a warp's specials, by isa::Special. Specials that no shader reads have kNoRow,
  // except LaneId to LaunchZ, which lie at the start: the machine reads there which thread a lane has.
  static constexpr uint8_t kNoRow = 0xff;
  std::array<uint8_t, size_t(isa::kNumSpecials)> special_row{};
  uint32_t num_special_rows = 0;

  std::string line_of(uint32_t pc) const;   // such as "shader.rchit:12", or the file or shader alone
  std::string place_of(uint32_t pc) const;  // such as "shader.rchit:12 (instruction 87: fma.rn.f32)"
};
Image link(const std::vector<isa::Program>& programs);

// A record whose handle is no group of the pipeline calls this. Its use is a fault.
inline constexpr uint32_t kForeignShader = kNoShader - 1;

// Holds a hit group: indices into Image::shaders, or kNoShader. In a foreign record `closest_hit` says so.
struct HitGroup {
  uint32_t closest_hit = kNoShader, any_hit = kNoShader, intersection = kNoShader;
};

// The handle of a group, at the start of a record, has the published drivers' shaderGroupHandleSize.
inline constexpr uint32_t kHandleBytes = 32;

// Holds the records of one kind in the shader binding table (VkStridedDeviceAddressRegionKHR). With stride 0,
// every index means the first record.
struct RecordRegion {
  Address base = 0;
  uint32_t stride = kHandleBytes;
  uint32_t number(uint32_t index) const { return stride ? index : 0; }
  Address address(uint32_t index) const { return base + Address(index) * stride; }
};

// Says where the records lie. Their data follow the handle, and World says what they call.
struct BindingTable {
  Address raygen = 0;
  RecordRegion miss, hit, callable;
};

// Holds images and samplers that several launches have in common, such as those of a descriptor set with
// thousands of them. No launch changes it.
struct ImagePool {
  std::vector<ImageView> images;
  std::vector<Sampler> samplers;
};

// Holds everything that a launch gives to its warps. It is not written while warps run, except for the
// memory's contents.
struct World {
  const Image* image = nullptr;
  mem::AddressSpace* memory = nullptr;
  PrintLog* prints = nullptr;            // where print and print.part go; null: nowhere
  std::vector<std::byte> constant_bank;  // kConstantBankBytes: descriptors and push constants (isa/program.h)
  // Texture and image handles (isa/image_access.h) number the images and samplers of `pool` first, and then
  // the launch's own. The samplers are those in addition to the images' own.
  const ImagePool* pool = nullptr;  // null: none
  std::vector<ImageView> images;
  std::vector<Sampler> samplers;
  // With these, accesses outside of buffers and images read 0 and write nothing, and are not faults, as
  // Vulkan's robustBufferAccess2 and robustImageAccess2 demand. Choice: the weaker features also allow other
  // values, and stores to other places of the same buffer; Glint has one behaviour for all of them.
  bool robust_images = false, robust_buffers = false;
  OnFault on_fault = OnFault::Stop;
  uint32_t raygen = kNoShader;  // the ray generation shader, or the compute shader
  std::vector<uint32_t> miss;   // the shader that each record of the binding table calls, or kNoShader
  std::vector<HitGroup> hit;
  std::vector<uint32_t> callable;
  BindingTable table;
  std::array<uint32_t, 3> launch_size{1, 1, 1};  // number of threads
  // The launch may be a window of a larger one: what shaders read as their id begins at `first_id`, which is
  // a multiple of `block_size`. Without blocks they read `whole_size` as the launch's size. With zeros the
  // launch is whole.
  std::array<uint32_t, 3> first_id{0, 0, 0}, whole_size{0, 0, 0};
  // These are the threads of a block (at most kMaxBlockThreads); `launch_size` is then a multiple of it in
  // each direction. With zeros the launch has no blocks, and each warp is a block of its own (ray
  // generation); `layout` says which threads it has.
  std::array<uint32_t, 3> block_size{0, 0, 0};
  bool in_clusters = false;                       // each block is a cluster of its own, which only costs time
  std::shared_ptr<const WarpLayout> layout;       // null: linear
  uint32_t shared_bytes = 0;                      // shared memory of a block
  uint32_t dynamic_shared_bytes = 0;              // the part of it that the launch asked for, not the program
  std::shared_ptr<const rt::AnyHitMode> any_hit;  // null: immediate
  std::shared_ptr<const rt::LeafFilter> filter;   // null: any-hit shaders decide what is not opaque
  bool nearest_first_hit = true;                  // rt::TraversalRules::end_at_first_hit is its opposite
  uint32_t added_ray_flags = 0;                   // that each rt.trace has besides its own
  TraversalCode traversal;                        // empty: the RT unit walks rays
  uint32_t local_bytes = 0;                       // bytes of a lane's stack and of what `traversal` needs
  uint32_t max_trace_depth = 1;                   // nested rt.trace (Vulkan's recursion depth)
  // This many executeCallableEXT can be nested. Choice: Vulkan only limits the stack's bytes.
  uint32_t max_callable_depth = 31;

  size_t pool_images() const { return pool ? pool->images.size() : 0; }
  size_t pool_samplers() const { return pool ? pool->samplers.size() : 0; }
  size_t num_images() const { return pool_images() + images.size(); }
  size_t num_samplers() const { return pool_samplers() + samplers.size(); }
  const ImageView& image_at(size_t number) const {
    return number < pool_images() ? pool->images[number] : images[number - pool_images()];
  }
  const Sampler& sampler_at(size_t number) const {
    return number < pool_samplers() ? pool->samplers[number] : samplers[number - pool_samplers()];
  }
};

// Return the bytes of a binding table whose records have no data, and put that table at `base`. Its order is
// ray generation, miss, hit, callable.
uint64_t plain_table_bytes(const World& world);
void place_plain_table(World& world, Address base);

// Sets sizes and shared memory for a grid of blocks of threads. `dynamic_bytes` come after the program's own.
void set_blocks(World& world, std::array<uint32_t, 3> grid, std::array<uint32_t, 3> block,
                uint32_t static_bytes, uint32_t dynamic_bytes = 0);
// Lets the numbers of blocks begin at `first`, as vkCmdDispatchBase does. It is called after set_blocks().
void set_first_block(World& world, std::array<uint32_t, 3> first);

}  // namespace glint::exec
