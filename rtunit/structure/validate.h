// Checks what a traversal relies on in the bytes of an acceleration structure.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "memsys/address_space.h"

namespace glint::rt {

// Walks the structure whose header is at `address`, and every bottom level below a top level. Returns at most
// 100 errors, and none when the structure is sound. These are errors: a box that does not contain the
// geometry below it, a reference outside the allocation, a primitive or instance that is missing or lies in
// two leaves, and a stack need above what the header says.
std::vector<std::string> validate(const mem::AddressSpace& memory, Address address);

}  // namespace glint::rt
