// Holds the name of the commit in a file of its own, the only one that is compiled again when it changes.
// SPDX-License-Identifier: Apache-2.0
#include "setup/build_commit.h"

namespace glint::setup {

std::string_view build_commit() {
  return GLINT_GIT;
}

}  // namespace glint::setup
