// Tests that geometry in memory of a program is read as Vulkan lays it out.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/device_geometry.h"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "tests/support/catch.h"

namespace glint::pipeline {
namespace {

template <class T>
Address place(mem::AddressSpace& memory, const std::vector<T>& values) {
  const Address at = memory.allocate("values", values.size() * sizeof(T));
  memory.write(at, values.data(), values.size() * sizeof(T));
  return at;
}

const std::vector<float> kCorners{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5f};

// Encodes a bottom level of the same two triangles, which were given as plain positions.
rt::EncodedStructure plain(std::array<float, 12> transform = rt::kIdentity) {
  const std::vector<uint32_t> indices{0, 1, 2, 1, 3, 2};
  rt::Geometry geometry;
  geometry.positions = std::as_bytes(std::span(kCorners));
  geometry.indices = indices;
  geometry.transform = transform;
  return rt::encode_bottom("plain", {{geometry}});
}

void check_same(const DeviceGeometry& geometry, const rt::EncodedStructure& expected) {
  const rt::EncodedStructure read = rt::encode_bottom("read", geometry.level());
  REQUIRE(read.bytes.size() == expected.bytes.size());
  CHECK(std::memcmp(read.bytes.data(), expected.bytes.data(), read.bytes.size()) == 0);
  CHECK(geometry.notes().empty());
}

TEST_CASE("indices of every width, and none, give the structure of the same triangles") {
  mem::AddressSpace memory;
  const Address vertices = place(memory, kCorners);
  const Address indices[] = {place(memory, std::vector<uint8_t>{9, 9, 9, 0, 1, 2, 1, 3, 2}) + 3,
                             place(memory, std::vector<uint16_t>{0, 1, 2, 1, 3, 2}),
                             place(memory, std::vector<uint32_t>{0, 1, 2, 1, 3, 2})};
  const uint32_t widths[] = {1, 2, 4};
  for (size_t i = 0; i < 3; ++i) {
    DeviceGeometry geometry(memory);
    geometry.add({.vertices = vertices, .index_bytes = widths[i], .indices = indices[i], .count = 2});
    check_same(geometry, plain());
  }
  std::vector<float> each{7, 7, 7};  // vertex 0, which is left out by first_vertex
  for (const size_t i : {0u, 1u, 2u, 1u, 3u, 2u})
    each.insert(each.end(), kCorners.begin() + std::ptrdiff_t(3 * i),
                kCorners.begin() + std::ptrdiff_t(3 * i + 3));
  DeviceGeometry geometry(memory);
  geometry.add({.vertices = place(memory, each), .first_vertex = 1, .count = 2});
  check_same(geometry, plain());
}

TEST_CASE("positions of other formats, strides and transforms are read") {
  mem::AddressSpace memory;
  const Address indices = place(memory, std::vector<uint32_t>{0, 1, 2, 1, 3, 2});
  const std::array<float, 12> transform{0, 2, 0, 1, 1, 0, 0, 5, 0, 0, 1, 0};
  const Address moved = place(memory, std::vector<float>(transform.begin(), transform.end()));
  // Halves and fractions of 16 bits of the same corners; the fourth channel is not read.
  const std::vector<uint16_t> halves{0, 0, 0, 9, 0x3c00, 0, 0, 9, 0, 0x3c00, 0, 9, 0x3c00, 0x3c00, 0x3800, 9};
  DeviceGeometry geometry(memory);
  geometry.add({.format = exec::TexelFormat::Rgba16Float,
                .vertices = place(memory, halves),
                .stride = 8,
                .index_bytes = 4,
                .indices = indices,
                .transform = moved,
                .count = 2});
  check_same(geometry, plain(transform));

  const std::vector<int16_t> flat{0, 0, -1, 32767, 0, -1, 0, 32767, -1};  // a stride of three channels
  DeviceGeometry two(memory);
  two.add({.format = exec::TexelFormat::Rg16Snorm, .vertices = place(memory, flat), .stride = 6, .count = 1});
  DeviceGeometry three(memory);
  three.add({.vertices = place(memory, kCorners), .count = 1});
  check_same(two, rt::encode_bottom("three", three.level()));
}

TEST_CASE("boxes with gaps are read, and those that are not numbers are inactive") {
  mem::AddressSpace memory;
  const std::vector<float> values{0, 0, 0,  1,  1, 1, 99, 99, NAN, 0, 0,  1,
                                  1, 1, 99, 99, 2, 2, 2,  3,  3,   3, 99, 99};
  DeviceGeometry geometry(memory);
  geometry.add({.boxes = place(memory, values), .stride = 32, .count = 3, .opaque = false});
  const rt::EncodedStructure read = rt::encode_bottom("boxes", geometry.level());
  CHECK(read.info.primitives == 2);
  CHECK(read.info.bounds == rt::Bounds{{0, 0, 0}, {3, 3, 3}});
}

TEST_CASE("what lies outside of memory is inactive and noted, and the rest is built") {
  mem::AddressSpace memory;
  const Address vertices = place(memory, kCorners);
  const Address indices = place(memory, std::vector<uint32_t>{0, 1, 2, 1, 4, 2, 0xffff'ffff, 0, 1, 0});
  DeviceGeometry geometry(memory);
  geometry.add({.vertices = vertices, .index_bytes = 4, .indices = indices, .transform = 64, .count = 5});
  geometry.add({.boxes = vertices, .count = 3});
  const rt::EncodedStructure read = rt::encode_bottom("partly", geometry.level());
  CHECK(read.info.primitives == 3);
  REQUIRE(geometry.notes().size() == 3);
  CHECK(geometry.notes()[0] == "geometry 0: 4 triangles lie outside of memory and are inactive");
  CHECK_THAT(geometry.notes()[1],
             Catch::Contains("geometry 0: its transform lies outside of memory: a null"));
  CHECK(geometry.notes()[2] == "geometry 1: 1 boxes lie outside of memory and are inactive");
}

}  // namespace
}  // namespace glint::pipeline
