// Walks encoded structures and compares them with what they hold.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/validate.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <set>
#include <tuple>
#include <utility>

#include "rtunit/node_format.h"
#include "rtunit/structure/build_tree.h"
#include "rtunit/traversal/ray_stack.h"

namespace glint::rt {
namespace {

constexpr size_t kMaxErrors = 100;

bool contains(const Bounds& outer, const Bounds& inner) {
  for (size_t a = 0; a < 3; ++a)
    if (!(outer.low[a] <= inner.low[a]) || !(outer.high[a] >= inner.high[a])) return false;
  return true;
}

class Validation {
 public:
  explicit Validation(const mem::AddressSpace& memory) : memory_(memory) {}

  // Holds the real bounds and the worst stack need of a structure.
  struct Measured {
    Bounds bounds = empty_bounds();
    uint32_t stack_need = 1;
  };

  Measured structure(Address address, int level) {
    StructureHeader header;
    if (!read(address, 0, header)) return {};
    if (header.magic != StructureHeader::kMagic || header.level != level) {
      error("{:#x} holds no header of a level-{} structure", address, level);
      return {};
    }
    const NodeFormat* format = find_format(header.format);
    if (!format) {
      error("{:#x}: unknown node format {:#x}", address, header.format);
      return {};
    }
    const Frame outer = frame_;
    if (outer.format && outer.format != format)
      error("{:#x}: node format {:#x} below another", address, header.format);
    frame_ = {address, header.bytes, format};
    std::set<Key> primitives;
    primitives.swap(primitives_);
    Measured out = internal(kRootBlock, 0);
    if (primitives_.size() != header.num_primitives)
      error("{:#x}: {} primitives reached, the header says {}", address, primitives_.size(),
            header.num_primitives);
    primitives_.swap(primitives);
    if (out.stack_need > header.stack_need)
      error("{:#x}: needs {} stack entries, the header says {}", address, out.stack_need, header.stack_need);
    if (header.num_primitives && !contains(header.bounds, out.bounds))
      error("{:#x}: the header's box is too small", address);
    if (level == 1 && out.stack_need > kStackEntries)
      error("{:#x}: needs {} stack entries, a ray has {}", address, out.stack_need, kStackEntries);
    frame_ = outer;
    return out;
  }

  std::vector<std::string> errors;

 private:
  using Key = std::tuple<uint32_t, uint32_t>;
  struct Frame {
    Address base = 0;
    uint64_t bytes = 0;
    const NodeFormat* format = nullptr;
  };

  template <class... Args>
  void error(fmt::format_string<Args...> text, Args&&... args) {
    if (errors.size() < kMaxErrors) errors.push_back(fmt::format(text, std::forward<Args>(args)...));
  }
  template <class T>
  bool read(Address base, uint32_t block, T& out) {
    const Address at = base + Address(block) * kBlockBytes;
    const std::byte* bytes = memory_.find(at, sizeof out);
    if (bytes)
      std::memcpy(&out, bytes, sizeof out);
    else
      error("{}", memory_.explain(at, sizeof out));
    return bytes != nullptr;
  }
  void reached(uint32_t geometry, uint32_t primitive) {
    if (!primitives_.emplace(geometry, primitive).second)
      error("{:#x}: primitive {} of geometry {} lies in two leaves", frame_.base, primitive, geometry);
  }

  Measured internal(uint32_t block, uint32_t depth) {
    Measured out;
    const std::byte* bytes =
        memory_.find(frame_.base + Address(block) * kBlockBytes, frame_.format->node_bytes());
    if (!bytes || depth > kStackEntries) {
      error("{:#x}: block {} at depth {} is outside or deeper than any stack", frame_.base, block, depth);
      return out;
    }
    std::array<DecodedChild, kMaxWidth> children;
    const uint32_t count = frame_.format->decode(bytes, children);
    for (uint32_t i = 0; i < count; ++i) {
      const Measured below = child(children[i].node, depth);
      if (!contains(children[i].bounds, below.bounds))
        error("{:#x}: child {} of block {} is larger than its box", frame_.base, i, block);
      extend(out.bounds, below.bounds);
      out.stack_need = std::max(out.stack_need, count - 1 + below.stack_need);
    }
    return out;
  }

  Measured child(NodeRef ref, uint32_t depth) {
    const uint32_t block = block_of(ref);
    switch (kind_of(ref)) {
      case NodeKind::Internal:
        return internal(block, depth + 1);
      case NodeKind::Instance:
        return instance(block);
      case NodeKind::Triangle:
        return triangles(block);
      case NodeKind::Procedural: {
        Measured out;
        ProceduralLeaf leaf;
        if (!read(frame_.base, block, leaf)) return out;
        reached(leaf.geometry, leaf.primitive);
        out.bounds = leaf.box;
        return out;
      }
      case NodeKind::TriangleSecond:
        break;
    }
    error("{:#x}: block {} has kind {}", frame_.base, block, int(kind_of(ref)));
    return {};
  }

  Measured triangles(uint32_t block) {
    Measured out;
    TriangleLeaf leaf;
    if (!read(frame_.base, block, leaf)) return out;
    if (leaf.count < 1 || leaf.count > 2)
      error("{:#x}: block {} holds {} triangles", frame_.base, block, leaf.count);
    for (uint32_t i = 0; i < leaf.count && i < 2; ++i) {
      reached(leaf.geometry, leaf.primitive_of(i));
      for (uint32_t corner = 0; corner < 3; ++corner) {
        const auto& p = leaf.vertex[i ? leaf.second >> (2 * corner) & 3 : corner];
        extend(out.bounds, {p, p});
      }
    }
    return out;
  }

  Measured instance(uint32_t block) {
    Measured out;
    InstanceLeaf leaf;
    if (!read(frame_.base, block, leaf)) return out;
    reached(0, leaf.instance);
    const Measured bottom = structure(leaf.structure, 0);
    out.stack_need = bottom.stack_need;
    // Corners are computed in double and rounded inwards by half an ulp at most, so a sound box holds them.
    for (int corner = 0; corner < 8; ++corner) {
      std::array<float, 3> p;
      for (size_t r = 0; r < 3; ++r) {
        double x = leaf.object_to_world[4 * r + 3];
        for (size_t c = 0; c < 3; ++c)
          x += double(leaf.object_to_world[4 * r + c]) *
               (corner >> c & 1 ? bottom.bounds.high[c] : bottom.bounds.low[c]);
        p[r] = float(x);
      }
      extend(out.bounds, {p, p});
    }
    return out;
  }

  const mem::AddressSpace& memory_;
  Frame frame_;
  std::set<Key> primitives_;
};

}  // namespace

std::vector<std::string> validate(const mem::AddressSpace& memory, Address address) {
  Validation validation(memory);
  StructureHeader header;
  const std::byte* bytes = memory.find(address, sizeof header);
  if (!bytes) return {memory.explain(address, sizeof header)};
  std::memcpy(&header, bytes, sizeof header);
  validation.structure(address, header.level == 1 ? 1 : 0);
  return std::move(validation.errors);
}

}  // namespace glint::rt
