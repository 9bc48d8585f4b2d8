// A resolved configuration as a TOML file that says unit, meaning and range of each key and loads back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/params.h"

namespace glint::report {

// `title` becomes the first comment line. Every key stands in the table of its dotted prefix.
std::string config_file(const std::vector<ParamInfo>& params, const std::string& title);

// "key=value" lines of all parameters, without comments: what configuration hashes are taken of.
std::string config_key_values(const std::vector<ParamInfo>& params);

// 64-bit FNV-1a (constants of the published definition): names a configuration, no protection against intent.
uint64_t fnv1a(const std::string& bytes);

}  // namespace glint::report
