// Handles structures that lie in memory of a program: finds them by address, copies and serialises them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "memsys/address_space.h"
#include "rtunit/structure/build.h"

namespace glint::rt {

// Holds an instance as Vulkan lays it out in memory (VkAccelerationStructureInstanceKHR).
struct DeviceInstance {
  std::array<float, 12> transform = kIdentity;  // object to world, row-major 3x4
  uint32_t custom_index_and_mask = 0;           // low 24 bits index, high 8 mask
  uint32_t sbt_offset_and_flags = 0;            // low 24 bits offset, high 8 instance_flag::*
  Address structure = 0;                        // of a bottom level; 0: the instance is inactive
};
static_assert(sizeof(DeviceInstance) == 64);

// Returns what the header at an address says of the structure there. It knows neither nodes, leaves nor
// depth, which are 0. It returns nothing where no whole structure is.
std::optional<StructureInfo> structure_at(const mem::AddressSpace& memory, Address address);

// Encodes a top level over instances that name their bottom levels by address. An instance whose bottom level
// is not there, has another node format, or cannot be reached by any ray is inactive and noted. Throws
// UserError when the trees are too deep for the ray stack.
EncodedStructure encode_top(const mem::AddressSpace& memory, const std::string& name,
                            std::span<const DeviceInstance> instances, const BuildOptions& options,
                            std::vector<std::string>& notes);

// The functions below throw UserError when no structure is at `from`, or when there is no room at `to`. An
// address `to` has to be a multiple of kLeafBytes.

// Writes a structure to bytes that are there already.
void write_structure(mem::AddressSpace& memory, const EncodedStructure& structure, Address to);
// Copies a structure. It takes StructureInfo::bytes, which may be less than the bytes that it was given: this
// is what compaction saves.
void copy_structure(mem::AddressSpace& memory, Address from, Address to);

// Begins a serialised structure, as Vulkan lays it out ("vkCmdCopyAccelerationStructureToMemoryKHR").
// `num_bottoms` addresses of bottom levels follow it, one for each active instance, and then the structure.
struct SerialHeader {
  std::array<uint8_t, 16> driver{};         // the driver's UUID
  std::array<uint8_t, 16> compatibility{};  // kSerialVersion
  uint64_t serial_bytes = 0;                // of all
  uint64_t bytes = 0;                       // that the structure needs
  uint64_t num_bottoms = 0;
};
static_assert(sizeof(SerialHeader) == 56);
// It changes whenever the bytes of structures mean something else.
inline constexpr std::array<uint8_t, 16> kSerialVersion{'G', 'l', 'i', 'n', 't', ' ', 's', 't',
                                                        'r', 'u', 'c', 't', ' ', '0', '0', '1'};

// Returns the bottom levels of the active instances of a structure, in the order in which it holds them. A
// bottom level has none.
std::vector<Address> bottoms_of(const mem::AddressSpace& memory, Address from);
uint64_t serial_bytes(const mem::AddressSpace& memory, Address from);
// Writes serial_bytes() bytes to `to`.
void serialize(const mem::AddressSpace& memory, Address from, const std::array<uint8_t, 16>& driver,
               std::span<std::byte> to);
// Writes the structure that serialize() made into memory, with the bottom levels that the list names now.
// Throws UserError when the bytes are damaged or have another version.
void deserialize(mem::AddressSpace& memory, std::span<const std::byte> from, Address to);

}  // namespace glint::rt
