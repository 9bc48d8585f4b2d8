// Reads the keys `opacity_maps` and `opacity_index` of a geometry.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "pipeline/description/read.h"

namespace glint::pipeline {

// Returns nothing where the geometry has neither key.
std::optional<OpacityDescription> read_opacity(Reading& r, TableReader& t, const SourceLocation& where);

}  // namespace glint::pipeline
