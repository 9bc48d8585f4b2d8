// Tests the address space: what is inside, what is outside, and what a fault message says.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/address_space.h"

#include <utility>

#include "tests/support/catch.h"

using namespace glint;
using mem::AddressSpace;

TEST_CASE("an allocation starts at a multiple of 4 GiB and address 0 is never one") {
  AddressSpace space;
  const Address a = space.allocate("a", 100), b = space.allocate("b", 100);
  CHECK(a == Address{1} << 32);
  CHECK(b == Address{2} << 32);
  CHECK(space.find(0, 1) == nullptr);
}

TEST_CASE("the last byte of an allocation is inside and the next is not") {
  AddressSpace space;
  const Address a = space.allocate("a", 100);
  CHECK(space.find(a + 99, 1) != nullptr);
  CHECK(space.find(a + 96, 4) == space.find(a, 1) + 96);
  CHECK(space.find(a + 97, 4) == nullptr);
  CHECK(space.find(a + 100, 1) == nullptr);
  CHECK(space.find(a - 1, 1) == nullptr);
}

TEST_CASE("memory is zero when allocated, aligned to 64 bytes, and keeps what is written") {
  AddressSpace space;
  const Address a = space.allocate("a", 64);
  CHECK(reinterpret_cast<uintptr_t>(space.find(a, 64)) % 64 == 0);
  CHECK(space.view<uint64_t>(a, 8)[7] == 0);
  const uint32_t value = 0xdead'beef;
  space.write(a + 8, &value, 4);
  CHECK(space.view<uint32_t>(a, 16)[2] == 0xdead'beef);
  CHECK(space.view<uint32_t>(a, 16)[3] == 0);
}

TEST_CASE("bytes that were made elsewhere become an allocation without being copied") {
  AddressSpace space;
  mem::HostBlock block(100);
  CHECK(reinterpret_cast<uintptr_t>(block.data()) % 64 == 0);
  block.data()[99] = std::byte{7};
  const std::byte* bytes = block.data();
  const Address a = space.adopt("a", std::move(block)), b = space.allocate("b", 1);
  CHECK(block.size() == 0);
  CHECK(space.find(a, 100) == bytes);
  CHECK(space.find(a + 99, 1)[0] == std::byte{7});
  CHECK(space.find(a + 100, 1) == nullptr);
  CHECK(b == Address{2} << 32);
}

TEST_CASE("physical addresses pack allocations at 256 byte steps") {
  AddressSpace space;
  const Address a = space.allocate("a", 257), b = space.allocate("b", 1), c = space.allocate("c", 0);
  CHECK(space.physical(a) == 0);
  CHECK(space.physical(a + 256) == 256);
  CHECK(space.physical(b) == 512);
  CHECK(space.physical(c) == 768);
  CHECK(space.bytes_allocated() == 768);
}

TEST_CASE("what the machine reserves takes physical room and no addresses") {
  AddressSpace space;
  const Address a = space.allocate("a", 4);
  CHECK(space.reserve(300) == 256);
  const Address b = space.allocate("b", 4);
  CHECK(b - a == Address{1} << AddressSpace::kShift);
  CHECK(space.physical(b) == 768);
}

TEST_CASE("a fault message names the nearest allocation and the distance to it") {
  AddressSpace space;
  const Address a = space.allocate("binding 4 (Vertices)", 1200), b = space.allocate("image", 16);
  CHECK(space.explain(a + 1216, 4) == "16 bytes past the end of 'binding 4 (Vertices)' (1200 bytes)");
  CHECK(space.explain(b - 4, 4) == "4 bytes before the start of 'image' (16 bytes)");
  CHECK(space.explain(a - 8, 4) == "8 bytes before the start of 'binding 4 (Vertices)' (1200 bytes)");
  CHECK(space.explain(a + 1198, 4) ==
        "4 bytes across the end of 'binding 4 (Vertices)' (1200 bytes), 2 of them past it");
  CHECK(space.explain(8, 4) ==
        "a null pointer plus 8 bytes: nothing is bound there, or the address was never set");
  CHECK(space.explain(Address{77} << 32, 4) == "no allocation is near");
}
