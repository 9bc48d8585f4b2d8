// Arrays as NumPy's files, format 1.0: numpy.lib.format in NumPy's documentation.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "base/cost_map.h"

namespace glint::report {

// `dtype` as NumPy writes it ("<f4"), `shape` as Python writes a tuple, `data` little endian and row by row.
std::string npy_bytes(const std::string& dtype, const std::string& shape, std::string_view data);

// Height x width numbers: <u4 of counts, each at most 2^32 - 1, else <f4.
std::string npy_of_map(const CostMap& map);

// Width, height and values of `map` from what npy_of_map() wrote. `name` stands in the message; UserError
// when it is something else.
void read_npy(const std::string& bytes, const std::string& name, CostMap& map);

}  // namespace glint::report
