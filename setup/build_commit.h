// Names the commit that the program was built from.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace glint::setup {

// Returns the commit's short hash, with "-dirty" behind it when files had changed. It is empty outside of a
// repository.
std::string_view build_commit();

}  // namespace glint::setup
