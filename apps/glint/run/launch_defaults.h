// Makes the launch file of a PTX kernel from its parameters, and a kernel to begin with, for `glint init`.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace glint::app {

// Returns a commented launch file for the kernel of `ptx_file` whose text is `text`; its path starts at
// `folder`. Of several kernels it launches the first and names the others. 64-bit integers become buffers,
// because they are mostly addresses. Throws UserError when the text has no kernel, has mistakes, or has a
// parameter that no launch file can give.
std::string default_launch(std::string_view text, const std::string& ptx_file, const std::string& folder);

// Returns a small kernel in PTX: each thread squares one number.
std::string_view starter_kernel();

}  // namespace glint::app
