// Lists the oracles of --oracle: what no hardware can have, to bound what an idea can gain before it is
// built.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "setup/resources.h"

namespace glint::setup {

// Returns name and meaning of every oracle.
std::vector<std::pair<std::string, std::string>> oracle_list();

// Returns the settings with the oracles before them, so that a setting of the user wins. An oracle stands as
// "oracle=NAME" until read_config() replaces it.
std::vector<std::string> with_oracles(const std::vector<std::string>& names,
                                      const std::vector<std::string>& settings);

// Returns the settings with those of an oracle in place of each "oracle=NAME". Throws UserError with the
// nearest name for an oracle that there is not.
std::vector<std::string> without_oracles(const Resources& resources,
                                         const std::vector<std::string>& settings);

}  // namespace glint::setup
