// Checks encoded acceleration structures byte by byte: what a traversal relies on.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "memsys/address_space.h"

namespace glint::rt {

// Walks the structure whose header is at `address` (a top level: and every bottom level below it). Errors,
// empty when it is sound: a box that does not contain the geometry below it, a reference outside the
// allocation, a primitive or instance that is missing or lies in two leaves, a stack need above what the
// header says. At most 100.
std::vector<std::string> validate(const mem::AddressSpace& memory, Address address);

}  // namespace glint::rt
