// Gathers the maps that leaves name, each pair of them once.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/micromap_table.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <map>

#include "base/check.h"

namespace glint::rt {
namespace {

// Copies maps into a table. The maps of a leaf's two triangles follow each other, so that the leaf needs one
// number.
class Gathering {
 public:
  // Returns the number of the first triangle's map, which is one less than that of the second.
  uint32_t number_of(uint32_t geometry, const Micromaps& from, const std::array<int32_t, 2>& index) {
    const auto [place, is_new] = numbers_.try_emplace({int64_t{geometry}, index[0], index[1]}, num_maps_);
    if (!is_new) return place->second;
    if (index[0] < 0) --place->second;
    for (const int32_t map : index)
      if (map >= 0) add(from, uint32_t(map));
    return place->second;
  }

  std::vector<std::byte> table() const {
    const MicromapTable about{format_.two_states, format_.level, num_maps_, 0};
    std::vector<std::byte> out(sizeof about + states_.size());
    std::memcpy(out.data(), &about, sizeof about);
    if (!states_.empty()) std::memcpy(out.data() + sizeof about, states_.data(), states_.size());
    return out;
  }

 private:
  void add(const Micromaps& from, uint32_t map) {
    GLINT_CHECK(num_maps_ == 0 || from.format == format_, "geometries have micromaps of different formats");
    format_ = from.format;
    const size_t bytes = format_.bytes(), first = map * bytes;
    GLINT_CHECK(first + bytes <= from.states.size(), "a triangle names micromap {}, which is not there", map);
    states_.insert(states_.end(), from.states.begin() + ptrdiff_t(first),
                   from.states.begin() + ptrdiff_t(first + bytes));
    ++num_maps_;
  }

  MicromapFormat format_;
  uint32_t num_maps_ = 0;
  std::vector<uint8_t> states_;
  std::map<std::array<int64_t, 3>, uint32_t> numbers_;  // by geometry and the numbers of both maps
};

}  // namespace

std::vector<std::byte> take_micromaps(const BottomLevel& input, Leaves& leaves) {
  Gathering maps;
  bool has_any = false;
  for (const BuildItem& item : leaves.items) {
    if (kind_of(item.leaf) != NodeKind::Triangle) continue;
    std::byte* const at = leaves.bytes.data() + size_t{block_of(item.leaf)} * kBlockBytes;
    auto leaf = load<TriangleLeaf>(at);
    const Micromaps* const from = input.geometries[leaf.geometry].micromaps;
    if (!from) continue;
    has_any = true;
    std::array<int32_t, 2> index{-1, -1};
    for (uint32_t i = 0; i < leaf.count; ++i) {
      const uint32_t primitive = leaf.primitive_of(i);
      GLINT_CHECK(primitive < from->index.size(), "triangle {} has no entry in its micromaps", primitive);
      index[i] = from->index[primitive];
      const uint32_t code =
          index[i] < 0 ? TriangleLeaf::kUniform + uint32_t(-1 - index[i]) : TriangleLeaf::kMapped;
      leaf.opacity = uint8_t(leaf.opacity | code << 3 * i);
    }
    if (from->come_first) leaf.opacity |= TriangleLeaf::kMapsFirst;
    if (index[0] >= 0 || index[1] >= 0) leaf.primitive[1] = maps.number_of(leaf.geometry, *from, index);
    std::memcpy(at, &leaf, sizeof leaf);
  }
  return has_any ? maps.table() : std::vector<std::byte>{};
}

}  // namespace glint::rt
