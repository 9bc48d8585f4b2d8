// Guesses values of shader parameters by their names, so that the first picture of a new pipeline shows
// something.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "frontend/spirv/block_type.h"
#include "frontend/spirv/specialize.h"

namespace glint::pipeline {

// Returns the name of a buffer that an address may lead to.
using NameTarget = std::function<std::string(const std::string& member, const frontend::BlockType& target)>;

// Returns what an address leads to, or null. A number of 64 bits is an address where its name says so. It
// then leads to floats, or to whole numbers where the name is that of indices.
const frontend::BlockType* target_of(const std::string& name, const frontend::BlockType& type);

// Returns whether a block has addresses that lead to something.
bool has_targets(const std::string& name, const frontend::BlockType& type);

// Returns a TOML value of a type: numbers, a list, or a table of members. Matrices, eyes and directions
// belong to a camera at (0, 1, 4) that looks at the origin, lights shine from above, sizes are the launch's
// `side`, other numbers of floating point are 1, and other integers are 0. Choice: a value that is 0
// everywhere would make most pictures black. An address whose target is known is the name of a buffer.
// Run-time arrays have one element where that has addresses, and otherwise none.
std::string usual_value(const std::string& name, const frontend::BlockType& type, uint32_t side,
                        const NameTarget& name_target);

// Returns the default of a specialisation constant as the value of a key.
std::string default_text(const frontend::SpecConstant& constant);

}  // namespace glint::pipeline
