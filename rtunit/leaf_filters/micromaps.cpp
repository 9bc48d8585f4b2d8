// Implements the leaf filter `micromaps`: opacity micromaps decide where a triangle is opaque or transparent.
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "base/registry.h"
#include "memsys/request.h"
#include "rtunit/leaf_filter.h"

namespace glint::rt {
namespace {

Opacity opacity_of(MicroState state, bool two_states) {
  switch (state) {
    case MicroState::Transparent:
      return Opacity::Transparent;
    case MicroState::Opaque:
      return Opacity::Opaque;
    case MicroState::UnknownTransparent:
      return two_states ? Opacity::Transparent : Opacity::Unknown;
    case MicroState::UnknownOpaque:
      return two_states ? Opacity::Opaque : Opacity::Unknown;
  }
  return Opacity::Unknown;
}

// Model: a map's format is known to the unit, and comes with no read of its own. What is the same all over a
// triangle lies in the leaf; otherwise the unit reads the sector with the micro-triangle's state.
class MicromapFilter final : public LeafFilter {
 public:
  static constexpr std::string_view kName = "micromaps";
  static_assert(kName == kMicromaps);
  static constexpr std::string_view kDoc =
      "Opacity micromaps say where alpha-tested triangles are opaque or transparent; shaders decide the "
      "rest.";
  struct Params {
    bool two_states = false;
    uint32_t level = 4;  // Choice: 256 micro-triangles, whose states take 64 B; hardware allows 12 levels
    static ParamList params() {
      return {
          flag(&Params::two_states, "two_states",
               "True: a micro-triangle is opaque or transparent, as the alpha test says at its centre, and "
               "no shader is asked. False: it is also unknown where its texels differ, and the any-hit "
               "shader decides."),
          param(&Params::level, "level", "level",
                "Number of times that each triangle is cut into four micro-triangles.", 0,
                MicromapFormat::kMostLevels)};
    }
  };
  MicromapFilter(Params params, Context context)
      : format_{params.two_states, params.level}, memory_(context.memory), stats_(context.stats) {}

  std::optional<MicromapFormat> micromaps() const override { return format_; }

  LeafAnswer look_up(const LeafQuestion& question) const override {
    const uint32_t code = question.leaf.opacity_of(question.number);
    if (code == TriangleLeaf::kNoOpacity) return {};
    if (code != TriangleLeaf::kMapped)
      return {opacity_of(MicroState(code - TriangleLeaf::kUniform), question.two_states), 0};
    return look_up_map(question);
  }

  void looked_up(const LeafAnswer& answer) override {
    ++stats_.looked_up;
    ++*stats_.by_opacity[size_t(answer.opacity)];
    if (!answer.from) return;
    ++stats_.reads;
    stats_.bytes += mem::kSectorBytes;
  }

 private:
  struct Stats {
    explicit Stats(stats::Group* parent) : group(parent, "micromaps") {}
    stats::Group group;
    stats::Counter looked_up{&group, "looked_up", "candidate",
                             "Number of candidates that the filter was asked about."};
    stats::Counter opaque{&group, "opaque", "candidate",
                          "Number of candidates that were hits without a shader."};
    stats::Counter transparent{&group, "transparent", "candidate",
                               "Number of candidates that rays passed without a shader."};
    stats::Counter unknown{&group, "unknown", "candidate",
                           "Number of candidates that a shader had to decide."};
    stats::Counter reads{&group, "reads", "lane",
                         "Number of times that a lane read states. Lanes that read the same sector may share "
                         "a fetch."};
    stats::Counter bytes{&group, "bytes", "byte",
                         "Number of bytes of states that lanes read, before they share fetches."};
    stats::Counter* const by_opacity[3] = {&unknown, &opaque, &transparent};
  };

  // Bytes that a shader has overwritten may say anything.
  LeafAnswer look_up_map(const LeafQuestion& question) const {
    const std::byte* header = memory_.find(question.structure, sizeof(StructureHeader));
    if (!header) return {};
    const auto block = load<uint32_t>(header + offsetof(StructureHeader, micromaps));
    const Address at = question.structure + Address{block} * kBlockBytes;
    const std::byte* bytes = block ? memory_.find(at, sizeof(MicromapTable)) : nullptr;
    if (!bytes) return {};
    const auto table = load<MicromapTable>(bytes);
    const uint32_t map = question.leaf.map_of(question.number);
    if (table.level > MicromapFormat::kMostLevels || map >= table.num_maps) return {};
    const MicromapFormat format = table.format();
    const uint32_t number =
        number_of(micro_triangle_at(question.candidate.u, question.candidate.v, format.level), format.level);
    const Address first = at + sizeof table + Address{map} * format.bytes();
    const std::byte* states = memory_.find(first, format.bytes());
    if (!states) return {};
    const MicroState state = micro_state(format, reinterpret_cast<const uint8_t*>(states), number);
    const Address from = first + number * format.bits() / 8;
    return {opacity_of(state, question.two_states), from & ~Address{mem::kSectorBytes - 1}};
  }

  const MicromapFormat format_;
  const mem::AddressSpace& memory_;
  Stats stats_;
};

const Register<LeafFilter, MicromapFilter> registered;

}  // namespace
}  // namespace glint::rt
