// Turns the instances of a top level into leaves.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "rtunit/structure/build.h"
#include "rtunit/structure/leaves.h"

namespace glint::rt {

// Makes the leaves of a top level whose bottom levels have the node format `format`. Instances without a
// leaf, and what is thrown, are those of encode_top().
Leaves top_leaves(const std::string& name, std::span<const Instance> instances,
                  std::span<const StructureInfo> bottoms, FormatId format, std::vector<std::string>* notes);

}  // namespace glint::rt
