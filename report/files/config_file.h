// Writes a resolved configuration as a TOML file that gives unit, meaning and range of each key and loads
// back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/params.h"

namespace glint::report {

// Returns the file. `title` becomes the first comment line. Every key is in the table of its dotted prefix.
// Without `with_docs`, keys have no comments.
std::string config_file(const std::vector<ParamInfo>& params, const std::string& title,
                        bool with_docs = true);

// Returns "key=value" lines of all parameters without comments, from which configuration hashes are made.
std::string config_key_values(const std::vector<ParamInfo>& params);

// Returns the 64-bit FNV-1a hash (constants of the published definition). The hash names a configuration, and
// it protects against no intent.
uint64_t fnv1a(const std::string& bytes);

}  // namespace glint::report
