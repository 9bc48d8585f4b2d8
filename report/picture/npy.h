// Writes arrays as NumPy's files, format 1.0 (numpy.lib.format in NumPy's documentation).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "base/cost_map.h"

namespace glint::report {

// Returns a file. `dtype` is as NumPy writes it ("<f4"), `shape` is as Python writes a tuple, and `data` is
// little endian and row by row.
std::string npy_bytes(const std::string& dtype, const std::string& shape, std::string_view data);

// Returns height x width numbers: <u4 for counts that are at most 2^32 - 1, and <f4 otherwise.
std::string npy_of_map(const CostMap& map);

// Reads width, height and values of `map` from what npy_of_map() wrote. `name` is used in the message. Throws
// UserError when the bytes are something else.
void read_npy(const std::string& bytes, const std::string& name, CostMap& map);

}  // namespace glint::report
