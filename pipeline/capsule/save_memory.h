// Finds the simulated memory that a launch can reach, takes it along, and puts it back where it was.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "memsys/address_space.h"
#include "pipeline/capsule/capsule.h"

namespace glint::pipeline {

// Fills in the memory of a capsule whose launch is described otherwise, and drops those of its structures
// that the launch cannot reach. `own` are allocations that were made for the launch and are made again with
// it.
//
// A launch reaches whole allocations: those that descriptors and binding tables name, and the bottom levels
// of every structure in a reached allocation. If a shader can make addresses (buffer references, or
// structures from addresses), push constants and all reached allocations that images do not fill are
// searched, too: every aligned word of 64 bits that is an address in an allocation reaches it.
void save_memory(Capsule& capsule, mem::AddressSpace& memory, std::span<const Address> own);

// Puts the memory into an empty space. Throws UserError when the capsule contradicts itself.
void restore_memory(const SavedMemory& from, mem::AddressSpace& memory);

}  // namespace glint::pipeline
