// Finds where the registers of a wmma fragment lie.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/fragment.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace glint::frontend::ptx {
namespace {

// Lists the shapes with the types of their factors and sums (PTX ISA, "Matrix Shape" of wmma).
struct ShapeRow {
  const char* shape;
  uint32_t m, n, k;
  const char *factors, *sums;
};
constexpr const char kFactors16[] = " f16 bf16 s8 u8 ", kSums16[] = " f16 f32 s32 ";
constexpr ShapeRow kShapes[] = {
    {"m16n16k16", 16, 16, 16, kFactors16, kSums16}, {"m32n8k16", 32, 8, 16, kFactors16, kSums16},
    {"m8n32k16", 8, 32, 16, kFactors16, kSums16},   {"m16n16k8", 16, 16, 8, " tf32 ", " f32 "},
    {"m8n8k4", 8, 8, 4, " f64 ", " f64 "},          {"m8n8k32", 8, 8, 32, " s4 u4 ", " s32 "},
    {"m8n8k128", 8, 8, 128, " b1 ", " s32 "},
};

uint32_t bits_of(const std::string& type) {
  if (type == "bf16") return 16;
  if (type == "tf32") return 32;
  return uint32_t(std::stoul(type.substr(1)));
}

}  // namespace

Fragment::Origin Fragment::origin(uint32_t r) const {
  const uint32_t block = r % distinct;
  if (is_sum()) {
    // Pairs of elements, in one register or two, then the 8 rows below, then the next 8 columns.
    const uint32_t pair = per == 2 ? block : block / 2, side = per == 2 ? 0 : block % 2;
    const bool is_square = m == 16;
    return {is_square ? 8 * (pair % 2) : 8 * pair, (is_square ? 8 * (pair / 2) : 0) + side};
  }
  const uint32_t depth = 4 * per, blocks = k / depth;
  if (!is_outer_first()) return {8 * (block / blocks), depth * (block % blocks)};
  if ((matrix == 'a' ? m : n) == 8) return {0, depth * block};
  return {8 * (block % 2) + 16 * (block / (2 * blocks)), depth * (block / 2 % blocks)};
}

std::optional<Fragment> fragment_of(char matrix, const std::string& shape, const std::string& type) {
  const auto row = std::find_if(std::begin(kShapes), std::end(kShapes),
                                [&](const ShapeRow& known) { return shape == known.shape; });
  if (row == std::end(kShapes)) return {};
  const std::string types = matrix == 'c' ? row->sums : row->factors;
  if (types.find(" " + type + " ") == std::string::npos) return {};
  Fragment out;
  out.matrix = matrix;
  out.m = row->m;
  out.n = row->n;
  out.k = row->k;
  out.type = type;
  out.bits = bits_of(type);
  out.per = out.bits >= 32 ? 1 : 32 / out.bits;
  out.step = matrix == 'c' ? 2 : out.per;
  const uint32_t elements = (matrix == 'a'   ? row->m * row->k
                             : matrix == 'b' ? row->k * row->n
                                             : row->m * row->n);
  out.distinct = elements / 32 / out.per;
  // Halves have 8 registers in every shape, as the first tensor cores needed them.
  out.registers = type == "f16" && matrix != 'c' ? 8 : out.distinct;
  return out;
}

std::optional<FragmentProduct> fragment_product(const std::vector<std::string>& words) {
  // wmma.mma[.xor|.and.popc].sync.aligned.LAYOUT.LAYOUT.SHAPE.D[.A.B].C[.satfinite]; without A and B they are
  // halves.
  std::vector<std::string> rest(words.begin() + std::min<ptrdiff_t>(2, ptrdiff_t(words.size())), words.end());
  const bool of_bits = rest.size() > 2 && rest[1] == "popc";
  const std::string combine = of_bits ? "." + rest[0] + ".popc" : "";
  if (of_bits) rest.erase(rest.begin(), rest.begin() + 2);
  const bool clamps = !rest.empty() && rest.back() == "satfinite";
  if (clamps) rest.pop_back();
  // Doubles are rounded to nearest even, with and without a word for it.
  if (rest.size() == 10 && rest[4] == "m8n8k4") std::erase(rest, "rn");
  if (rest.size() == 7) rest.insert(rest.begin() + 6, {"f16", "f16"});
  if (rest.size() != 9 || rest[0] != "sync" || rest[1] != "aligned") return {};
  const bool has_layouts = (rest[2] == "row" || rest[2] == "col") && (rest[3] == "row" || rest[3] == "col");
  const auto a = fragment_of('a', rest[4], rest[6]), b = fragment_of('b', rest[4], rest[7]),
             c = fragment_of('c', rest[4], rest[8]), d = fragment_of('c', rest[4], rest[5]);
  if (!has_layouts || !a || !b || !c || !d || a->type != b->type) return {};
  const bool mixes = c->type != d->type && c->bits != 64;
  if (mixes && (a->type != "f16" || c->type == "s32" || d->type == "s32")) return {};
  FragmentProduct out{*a, *b, *c, *d, "", 1, 1};
  out.steps = a->m * b->n / (a->m == 8 && b->n == 8 ? 64 : 128);
  const bool is_tf32 = a->type == "tf32";
  out.depths = is_tf32 ? 2 : 1;
  const std::string shape =
      out.a.m == 8 && out.b.n == 8 ? rest[4] : "m16n8k" + std::to_string(is_tf32 ? 4 : a->k);
  const std::string sum = mixes ? "f32" : d->type;
  out.op = "mma.sync.aligned." + shape + ".row.col" + (clamps ? ".satfinite." : ".") + sum + "." + a->type +
           "." + b->type + "." + sum + combine;
  return out;
}

}  // namespace glint::frontend::ptx
