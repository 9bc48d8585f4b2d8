// Writes capsules (launches of applications with all that they can reach) to files, and reads them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "pipeline/capsule/capsule.h"

namespace glint::setup {

inline constexpr const char* kCapsuleEnding = ".capsule";

// Returns the bytes of the file: a line with the version, a hash of all that follows, and, packed with zstd
// behind their number, a description in JSON and the bytes of memory and modules that the description names
// by place. The same capsule gives the same bytes with one version of zstd.
std::string capsule_bytes(const pipeline::Capsule& capsule);

// Throws UserError for a file that is none, that another version wrote, or that is damaged.
pipeline::Capsule read_capsule(const std::string& path);

}  // namespace glint::setup
