// Tests the address space: what is inside, what is outside, and what a fault message says.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/address_space.h"

#include <cstdint>
#include <utility>
#include <vector>

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

TEST_CASE("windows show the same bytes, and each has addresses and an end of its own") {
  AddressSpace space;
  const mem::Backing backing = space.add_backing(1000);
  const Address whole = space.open_window("whole", backing, 0, 1000),
                part = space.open_window("part", backing, 256, 100);
  CHECK(whole >> 32 != part >> 32);
  CHECK(space.find(part, 100) == space.data(backing) + 256);
  CHECK(space.find(part, 100) == space.find(whole + 256, 100));
  CHECK(space.physical(part) == space.physical(whole + 256));
  CHECK(space.find(part + 96, 4) != nullptr);
  CHECK(space.find(part + 97, 4) == nullptr);
  CHECK(space.find(part - 4, 4) == nullptr);
  CHECK(space.explain(part + 100, 4) == "0 bytes past the end of 'part' (100 bytes)");
  CHECK(space.bytes_allocated() == 1024);
}

TEST_CASE("a window that begins within a line keeps the alignment of its bytes, and has their exact end") {
  AddressSpace space;
  const mem::Backing backing = space.add_backing(256);
  const Address window = space.open_window("window", backing, 100, 20);
  CHECK(window % 64 == 36);
  CHECK(space.find(window, 20) == space.data(backing) + 100);
  CHECK(space.find(window, 21) == nullptr);
  CHECK(space.physical(window) == 100);
  CHECK(space.describe(window + 4) == "byte 4 of 'window' (20 bytes)");
  CHECK(space.explain(window + 24, 4) == "4 bytes past the end of 'window' (20 bytes)");
  CHECK(space.explain(window + 18, 4) == "4 bytes across the end of 'window' (20 bytes), 2 of them past it");
  space.free(window);
  CHECK(space.find(window, 1) == nullptr);
}

TEST_CASE("a window that reaches past its bytes is refused") {
  AddressSpace space;
  const mem::Backing backing = space.add_backing(100);
  CHECK_NOTHROW(space.open_window("w", backing, 100, 0));
  CHECK_THROWS_WITH(space.open_window("w", backing, 60, 41),
                    Catch::Contains("'w' is at bytes 60 to 101 of memory that has 100 bytes"));
  CHECK_THROWS_AS(space.open_window("w", backing, 8, ~uint64_t{0}), UserError);
}

TEST_CASE("bytes of somebody else become memory where they lie") {
  AddressSpace space;
  alignas(64) std::byte bytes[128] = {};
  const mem::Backing backing = space.import_backing(bytes, 128);
  const Address window = space.open_window("imported", backing, 64, 64);
  CHECK(space.find(window, 64) == bytes + 64);
  space.free(backing);
  CHECK(space.find(window, 1) == nullptr);
  CHECK_THROWS_AS(space.import_backing(bytes + 4, 64), UserError);
  CHECK_THROWS_AS(space.import_backing(bytes, 100), UserError);
}

TEST_CASE("what is freed is outside, and messages remember its name") {
  AddressSpace space;
  const Address a = space.allocate("a", 100), b = space.allocate("b", 100);
  space.free(a);
  CHECK(space.find(a, 1) == nullptr);
  CHECK(space.find(b, 1) != nullptr);
  CHECK(space.explain(a + 8, 4) == "byte 8 of 'a', which has been freed");
  CHECK(space.explain(b - 8, 4) == "8 bytes before the start of 'b' (100 bytes)");
  const mem::Backing backing = space.add_backing(64);
  const Address window = space.open_window("w", backing, 0, 64);
  space.free(backing);
  CHECK(space.find(window, 1) == nullptr);
  CHECK(space.explain(window, 4) == "byte 0 of 'w', which has been freed");
  space.free(window);
}

TEST_CASE("physical bytes are used again at once, and addresses late") {
  AddressSpace space;
  const Address a = space.allocate("a", 512), b = space.allocate("b", 256);
  space.free(a);
  CHECK(space.bytes_in_use() == 256);
  const Address c = space.allocate("c", 300), d = space.allocate("d", 1);
  CHECK(c > b);
  CHECK(space.physical(c) == 0);
  CHECK(space.physical(d) == 768);
  space.free(d);
  space.free(c);
  CHECK(space.bytes_allocated() == 768);
  space.free(b);
  CHECK(space.bytes_allocated() == 0);
  std::vector<Address> seen;
  for (int i = 0; i < 1000; ++i) {
    seen.push_back(space.allocate("e", 4));
    space.free(seen.back());
    if (i >= 60) CHECK(seen[size_t(i)] != seen[size_t(i - 60)]);
  }
  CHECK(space.slots().size() < 80);
}

TEST_CASE("what the machine gives back is reserved again at the same place") {
  AddressSpace space;
  space.allocate("a", 4);
  const Address first = space.reserve(300), second = space.reserve(1);
  space.release(second, 1);
  space.release(first, 300);
  CHECK(space.reserve(300) == first);
  CHECK(space.reserve(1) == second);
}

TEST_CASE("slots keep their places, and as many can be had as addresses have numbers") {
  AddressSpace space;
  const mem::Backing backing = space.add_backing(64);
  const Address first = space.open_window("first", backing, 0, 64);
  const AddressSpace::Slot* const slot = &space.slots()[1];
  for (uint64_t i = 2; i < AddressSpace::kMaxSlots; ++i) space.open_window("more", backing, 0, 4);
  CHECK(&space.slots()[1] == slot);
  CHECK(space.find(first, 64) == space.data(backing));
  CHECK_THROWS_AS(space.open_window("one too many", backing, 0, 4), mem::OutOfMemory);
  space.free(first);
  CHECK(space.open_window("again", backing, 0, 4) == first);
}

TEST_CASE("memory that is used up is an error, after which everything is as before") {
  AddressSpace space(1 << 20);
  const Address a = space.allocate("a", 1 << 19);
  CHECK_THROWS_AS(space.allocate("b", (1 << 19) + 1), mem::OutOfMemory);
  CHECK_THROWS_AS(space.allocate("b", ~uint64_t{0}), mem::OutOfMemory);
  CHECK_THROWS_WITH(space.reserve(1 << 20), Catch::Contains("need 1 MiB of simulated memory besides 1 MiB "
                                                            "that are in use, and there are 1"));
  CHECK(space.bytes_in_use() == 1 << 19);
  const Address b = space.allocate("b", 1 << 19);
  CHECK(b == a + (Address{1} << 32));
  space.free(b);
  CHECK_NOTHROW(space.reserve(1 << 19));
}

TEST_CASE("an allocation past 4 GiB is freed with all its numbers") {
  AddressSpace space;
  const uint64_t bytes = (uint64_t{1} << 32) + 100;
  const Address large = space.allocate("large", bytes), after = space.allocate("after", 4);
  CHECK(after == large + (Address{2} << 32));
  std::byte* const end = space.find(large + bytes - 1, 1);
  CHECK(end == space.find(large, 1) + bytes - 1);
  CHECK(space.find(large + bytes, 1) == nullptr);
  space.free(large);
  CHECK(space.find(large + bytes - 1, 1) == nullptr);
  CHECK(space.find(after, 4) != nullptr);
  CHECK(space.bytes_in_use() == 256);
}
