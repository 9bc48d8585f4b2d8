// Reads headers of structures, and patches the addresses in their leaves.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/in_memory.h"

#include <cstring>
#include <fmt/format.h>
#include <map>

#include "base/diagnostics.h"
#include "rtunit/traversal/ray_stack.h"

namespace glint::rt {
namespace {

// Returns the header of a structure that is whole.
std::optional<StructureHeader> header_of(std::span<const std::byte> bytes) {
  if (bytes.size() < sizeof(StructureHeader)) return {};
  const auto header = load<StructureHeader>(bytes.data());
  const bool is_whole = header.magic == StructureHeader::kMagic && header.bytes <= bytes.size() &&
                        header.bytes >= sizeof header && find_format(header.format);
  return is_whole ? std::optional(header) : std::nullopt;
}

// Returns the bytes of a structure in memory. Throws UserError where none is.
std::span<std::byte> bytes_at(const mem::AddressSpace& memory, Address address) {
  const auto info = structure_at(memory, address);
  if (!info)
    throw UserError({}, fmt::format("no acceleration structure is at address {:#x}", address),
                    "build it before it is used");
  return memory.view<std::byte>(address, info->bytes);
}

std::span<std::byte> room_at(const mem::AddressSpace& memory, Address address, uint64_t bytes) {
  if (address % kLeafBytes)
    throw UserError(fmt::format("a structure cannot begin at address {:#x}, which is not a multiple of {}",
                                address, kLeafBytes));
  if (std::byte* const to = memory.find(address, bytes)) return {to, size_t(bytes)};
  throw UserError({},
                  fmt::format("a structure of {} bytes has no room at address {:#x}: {}", bytes, address,
                              memory.explain(address, bytes)),
                  "give it the size that was asked for");
}

// Calls visit(leaf) with the bytes of every instance leaf of a whole top level. Damaged bytes may say
// anything, so the walk is bounded. Returns whether it met nothing that cannot be.
template <class Visit>
bool for_each_instance(std::span<std::byte> bytes, const StructureHeader& header, Visit&& visit) {
  const NodeFormat& format = *find_format(header.format);
  std::vector<DecodedChild> children(format.width());
  std::vector<uint32_t> open{kRootBlock};
  uint64_t nodes = 0, instances = 0;
  const auto at = [&](uint32_t block, uint64_t size) -> std::byte* {
    const uint64_t first = uint64_t{block} * kBlockBytes;
    return first + size <= bytes.size() ? bytes.data() + first : nullptr;
  };
  while (!open.empty()) {
    const std::byte* const node = at(open.back(), format.node_bytes());
    open.pop_back();
    if (!node || ++nodes > bytes.size() / format.node_bytes()) return false;
    const uint32_t count = format.decode(node, children);
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t block = block_of(children[i].node);
      if (kind_of(children[i].node) == NodeKind::Internal) {
        open.push_back(block);
        continue;
      }
      std::byte* const leaf = at(block, sizeof(InstanceLeaf));
      if (!leaf || kind_of(children[i].node) != NodeKind::Instance || ++instances > header.num_primitives)
        return false;
      visit(leaf);
    }
  }
  return instances == header.num_primitives;
}

}  // namespace

std::optional<StructureInfo> structure_at(const mem::AddressSpace& memory, Address address) {
  const std::byte* const begin = memory.find(address, sizeof(StructureHeader));
  if (!begin) return {};
  const uint64_t bytes = load<StructureHeader>(begin).bytes;
  if (bytes > kMostBytes || !memory.find(address, bytes)) return {};
  const auto header = header_of({begin, size_t(bytes)});
  if (!header) return {};
  StructureInfo info;
  info.address = address;
  info.bounds = header->bounds;
  info.bytes = header->bytes;
  info.format = header->format;
  info.primitives = header->num_primitives;
  info.stack_need = header->stack_need;
  info.contents = header->contents;
  return info;
}

namespace {

// Returns the bottom level at an address, if rays of the format can walk it. A shader may have overwritten
// it.
std::optional<StructureInfo> bottom_at(const mem::AddressSpace& memory, Address address, FormatId format) {
  const auto info = structure_at(memory, address);
  if (!info || info->format != format || info->stack_need > uint32_t(kStackEntries)) return {};
  const auto header = load<StructureHeader>(memory.find(address, sizeof(StructureHeader)));
  return header.level == 0 ? info : std::nullopt;
}

}  // namespace

EncodedStructure encode_top(const mem::AddressSpace& memory, const std::string& name,
                            std::span<const DeviceInstance> instances, const BuildOptions& options,
                            std::vector<std::string>& notes) {
  constexpr uint32_t kIndex = 0xff'ffff;
  const FormatId format = options.format.make({})->walk().format;
  std::vector<StructureInfo> bottoms(1);  // The first one is empty and stands for what is not there.
  bottoms[0].format = format;
  std::map<Address, uint32_t> known{{0, 0}};
  std::vector<Instance> out;
  for (size_t i = 0; i < instances.size(); ++i) {
    const DeviceInstance& from = instances[i];
    const auto [bottom, is_new] = known.try_emplace(from.structure, 0);
    if (is_new) {
      if (const auto info = bottom_at(memory, from.structure, format))
        bottom->second = uint32_t(bottoms.size()), bottoms.push_back(*info);
      else
        notes.push_back(
            fmt::format("'{}': instance {}: no bottom level of this node format is at address {:#x}", name, i,
                        from.structure));
    }
    out.push_back({from.transform, from.custom_index_and_mask & kIndex, from.custom_index_and_mask >> 24,
                   from.sbt_offset_and_flags & kIndex, from.sbt_offset_and_flags >> 24, bottom->second});
  }
  return encode_top(name, out, bottoms, options, &notes);
}

void write_structure(mem::AddressSpace& memory, const EncodedStructure& structure, Address to) {
  const auto room = room_at(memory, to, structure.bytes.size());
  std::memcpy(room.data(), structure.bytes.data(), room.size());
}

void copy_structure(mem::AddressSpace& memory, Address from, Address to) {
  const auto bytes = bytes_at(memory, from);
  std::memmove(room_at(memory, to, bytes.size()).data(), bytes.data(), bytes.size());
}

std::vector<Address> bottoms_of(const mem::AddressSpace& memory, Address from) {
  std::vector<Address> out;
  const auto bytes = bytes_at(memory, from);
  const StructureHeader header = *header_of(bytes);
  if (header.level != 0 && !for_each_instance(bytes, header, [&](const std::byte* leaf) {
        out.push_back(load<InstanceLeaf>(leaf).structure);
      }))
    throw UserError(fmt::format("the acceleration structure at address {:#x} has been overwritten", from));
  return out;
}

uint64_t serial_bytes(const mem::AddressSpace& memory, Address from) {
  return sizeof(SerialHeader) + bottoms_of(memory, from).size() * sizeof(Address) +
         bytes_at(memory, from).size();
}

void serialize(const mem::AddressSpace& memory, Address from, const std::array<uint8_t, 16>& driver,
               std::span<std::byte> to) {
  const std::vector<Address> bottoms = bottoms_of(memory, from);
  const auto bytes = bytes_at(memory, from);
  const SerialHeader header{driver, kSerialVersion, serial_bytes(memory, from), bytes.size(), bottoms.size()};
  if (to.size() < header.serial_bytes)
    throw UserError(
        fmt::format("a serialised structure of {} bytes has no room in {}", header.serial_bytes, to.size()));
  std::memcpy(to.data(), &header, sizeof header);
  if (!bottoms.empty())
    std::memcpy(to.data() + sizeof header, bottoms.data(), bottoms.size() * sizeof(Address));
  std::memcpy(to.data() + header.serial_bytes - bytes.size(), bytes.data(), bytes.size());
}

void deserialize(mem::AddressSpace& memory, std::span<const std::byte> from, Address to) {
  const auto refuse = [](const char* why) { throw UserError(fmt::format("a serialised structure {}", why)); };
  if (from.size() < sizeof(SerialHeader)) refuse("is shorter than its header");
  const auto serial = load<SerialHeader>(from.data());
  if (serial.compatibility != kSerialVersion) refuse("comes from another version of Glint");
  const uint64_t rest = from.size() - sizeof serial;
  if (serial.bytes > rest || serial.num_bottoms > (rest - serial.bytes) / sizeof(Address))
    refuse("is shorter than its header says");
  const std::byte* const list = from.data() + sizeof serial;
  const std::span<const std::byte> stored(list + serial.num_bottoms * sizeof(Address), size_t(serial.bytes));
  const auto header = header_of(stored);
  if (!header || header->bytes != serial.bytes) refuse("holds no structure");
  const auto room = room_at(memory, to, stored.size());
  std::memcpy(room.data(), stored.data(), stored.size());
  if (header->level == 0) return;
  uint64_t next = 0;
  const bool is_sound = for_each_instance(room, *header, [&](std::byte* leaf) {
    if (next < serial.num_bottoms)
      std::memcpy(leaf + offsetof(InstanceLeaf, structure), list + next * sizeof(Address), sizeof(Address));
    ++next;
  });
  if (!is_sound || next != serial.num_bottoms) refuse("is damaged");
}

}  // namespace glint::rt
