// Writes launch files that run as they are.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/launch_defaults.h"

#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/ptx/ptx.h"
#include "pipeline/description/defaults.h"

namespace glint::app {
namespace {

// Choice: these are the blocks and threads of a launch without .reqntid, and the elements of a buffer.
// Buffers are larger than the launch, because a thread may use several elements.
constexpr uint32_t kBlocks = 8, kThreads = 128, kElements = 65536;

bool uses(std::string_view text, std::string_view type) {
  for (const char* access : {"ld.global.", "st.global.", "ld.global.nc."})
    for (const char* vector : {"", "v2.", "v4."})
      if (text.find(fmt::format("{}{}{}", access, vector, type)) != std::string_view::npos) return true;
  return false;
}

// Returns the type that a kernel's buffers most likely have: the one that it loads and stores.
std::string element_type(std::string_view text) {
  return uses(text, "f32") ? "f32" : uses(text, "f64") ? "f64" : "u32";
}

std::string argument_text(const frontend::KernelParameter& parameter, std::string_view text,
                          const std::string& file) {
  const std::string type =
      (parameter.type[0] == 'b' ? "u" : parameter.type.substr(0, 1)) + parameter.type.substr(1);
  if (parameter.bytes * 8 != std::stoul(parameter.type.substr(1)) || parameter.bytes > 8 || type == "f16")
    throw UserError({file, 0, 0},
                    fmt::format("parameter '{}' has {} bytes of type {}, which a launch file cannot give",
                                parameter.name, parameter.bytes, parameter.type),
                    "an argument of a launch file is one number of up to 64 bits, or a buffer");
  const std::string head = fmt::format("\n[[argument]]  # {}, {}\n", parameter.name, parameter.type);
  if (type == "u64" || type == "s64")
    return head + fmt::format(
                      "buffer = {}  # or, if it is a number: {} = 0\ntype = \"{}\"\ncount = {}\n"
                      "init = \"iota\"  # zero, value, random, file\nsave = true\nshow = 8\n",
                      pipeline::quoted(parameter.name), type, element_type(text), kElements);
  return head + (type[0] == 'f'
                     ? fmt::format("{} = 1.0\n", type)
                     : fmt::format("{} = {}\n", type, type.ends_with("8") ? 1 : kBlocks * kThreads));
}

}  // namespace

std::string default_launch(std::string_view text, const std::string& ptx_file, const std::string& folder) {
  const std::vector<std::string> names = frontend::kernel_names(text, ptx_file);
  if (names.empty())
    throw UserError({ptx_file, 0, 0}, "the file has no kernel", "a kernel begins with .visible .entry NAME");
  const frontend::Kernel kernel = frontend::compile_ptx(text, ptx_file, names[0], {});
  std::array<uint32_t, 3> block{kThreads, 1, 1};
  if (kernel.required_block) block = *kernel.required_block;
  if (kernel.largest_block && block[0] > (*kernel.largest_block)[0]) block = *kernel.largest_block;
  std::string out = fmt::format(
      "# Written by `glint init`; shaders/kernels/README.md explains every key. Paths start at this file's "
      "folder.\nkernel = {}\n",
      pipeline::quoted(pipeline::path_from(ptx_file, folder)));
  if (names.size() > 1)
    out += fmt::format("entry = {}  # of {}\n", pipeline::quoted(names[0]), fmt::join(names, ", "));
  out += fmt::format("grid = {}  # blocks\nblock = [{}]  # threads\n", kBlocks, fmt::join(block, ", "));
  for (const frontend::KernelParameter& parameter : kernel.parameters)
    out += argument_text(parameter, text, ptx_file);
  return out;
}

std::string_view starter_kernel() {
  return R"(// Squares n numbers, one per thread.
.version 7.0
.target sm_70
.address_size 64

.visible .entry square(
	.param .u64 numbers,
	.param .u64 squares,
	.param .u32 n
)
{
	.reg .pred 	%p<2>;
	.reg .f32 	%f<3>;
	.reg .b32 	%r<6>;
	.reg .b64 	%rd<8>;

	// The number of the thread in the grid.
	mov.u32 	%r1, %ctaid.x;
	mov.u32 	%r2, %ntid.x;
	mov.u32 	%r3, %tid.x;
	mad.lo.u32 	%r4, %r1, %r2, %r3;
	ld.param.u32 	%r5, [n];
	setp.ge.u32 	%p1, %r4, %r5;
	@%p1 bra 	$done;

	ld.param.u64 	%rd1, [numbers];
	cvta.to.global.u64 	%rd2, %rd1;
	ld.param.u64 	%rd3, [squares];
	cvta.to.global.u64 	%rd4, %rd3;
	mul.wide.u32 	%rd5, %r4, 4;
	add.u64 	%rd6, %rd2, %rd5;
	add.u64 	%rd7, %rd4, %rd5;
	ld.global.f32 	%f1, [%rd6];
	mul.f32 	%f2, %f1, %f1;
	st.global.f32 	[%rd7], %f2;

$done:
	ret;
}
)";
}

}  // namespace glint::app
