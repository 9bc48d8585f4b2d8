// Bounds how many threads a launch may have.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "base/diagnostics.h"

namespace glint::pipeline {

// Choice: the threads of a launch have numbers of 32 bits. Vulkan and CUDA allow more in principle, but a GPU
// that starts a thousand million threads a second takes four seconds for so many.
inline constexpr uint64_t kMostThreads = 0xffff'ffff;

// Throws UserError at `where` when a launch of `grid` blocks of `block` threads has more than kMostThreads
// threads. A launch of rays has blocks of one thread.
void check_launch_size(const std::array<uint32_t, 3>& grid, const std::array<uint32_t, 3>& block,
                       const SourceLocation& where);

}  // namespace glint::pipeline
