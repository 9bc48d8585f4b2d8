// Tests that micromaps in memory of a program are read as Vulkan lays them out, and written in one format.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/device_micromaps.h"

#include <cstddef>
#include <cstring>
#include <vector>

#include "base/diagnostics.h"
#include "pipeline/device_geometry.h"
#include "tests/support/catch.h"

namespace glint::pipeline {
namespace {

const FindBytes kHost = [](Address at, uint64_t) { return reinterpret_cast<const std::byte*>(at); };

template <class T>
Address address_of(const std::vector<T>& values) {
  return reinterpret_cast<Address>(values.data());
}

// Is an array of two maps: one of 4 states with one part, and one of 2 states with 16 parts.
std::vector<std::byte> two_maps() {
  const std::vector<MicromapTriangle> triangles{{4, 0, 2}, {0, 2, 1}};
  const std::vector<uint8_t> data{0x0f, 0xa0, 0, 0, 3};
  return encode_micromaps(kHost, address_of(triangles), sizeof triangles[0], 2, address_of(data));
}

TEST_CASE("an array of micromaps has the size that its kinds say, and lies where it says") {
  const std::vector<std::byte> array = two_maps();
  const std::vector<MicromapUsage> usage{{1, 0, 2}, {1, 2, 1}};
  CHECK(array.size() == micromap_bytes(usage));
  CHECK(array.size() == 16 + 2 * 8 + 1 + 2);
  CHECK(micromap_array_at(kHost, address_of(array)).size() == array.size());
  std::vector<std::byte> damaged = array;
  damaged[0] = std::byte{0};
  CHECK(micromap_array_at(kHost, address_of(damaged)).empty());
}

TEST_CASE("coarser maps and those with fewer states are written without a loss") {
  const std::vector<std::byte> array = two_maps();
  const std::vector<uint16_t> indices{1, 0, 0xffff, 0xfffc, 0, 9};
  DeviceMicromaps from;
  from.index_bytes = 2, from.indices = address_of(indices), from.stride = 2, from.find_indices = kHost;
  from.array = array;
  const TakenMicromaps taken = take_micromaps(from, 6);
  CHECK(taken.index == std::vector<int32_t>{0, 1, -1, -4, 1, -4});
  CHECK(taken.unread == 1);
  REQUIRE(taken.maps.size() == 2);
  const rt::MicromapFormat format = common_format(taken.maps[0].format, taken.maps[1].format);
  CHECK(format == rt::MicromapFormat{false, 2});

  const rt::Micromaps written = in_format(taken, format);

  CHECK(written.come_first);
  CHECK(written.index == taken.index);
  // The first map had the bits 0xa00f, and the second one the state 3 alone.
  CHECK(written.states == std::vector<uint8_t>{0x55, 0, 0, 0x44, 0xff, 0xff, 0xff, 0xff});
}

TEST_CASE(
    "an index without a buffer is the triangle's number, and the base counts for all but special ones") {
  const std::vector<std::byte> array = two_maps();
  DeviceMicromaps from;
  from.base = 1, from.array = array;
  CHECK(take_micromaps(from, 1).index == std::vector<int32_t>{0});
  CHECK(take_micromaps(from, 2).unread == 1);
  const std::vector<uint32_t> indices{0xffff'fffe, 0};
  from.index_bytes = 4, from.indices = address_of(indices), from.stride = 4, from.find_indices = kHost;
  CHECK(take_micromaps(from, 2).index == std::vector<int32_t>{-2, 0});
}

TEST_CASE("kinds of micromaps that are not there are named") {
  const auto message = [](uint32_t level, uint32_t format) -> std::string {
    try {
      micromap_format(level, format);
    } catch (const UserError& error) {
      return error.what();
    }
    return {};
  };
  CHECK(message(6, 1).empty());
  CHECK(message(7, 1).find("subdivision level 7, and there are 0 to 6") != std::string::npos);
  CHECK(message(0, 3).find("format 3, and there are 1 (2 states) and 2 (4 states)") != std::string::npos);
}

}  // namespace
}  // namespace glint::pipeline
