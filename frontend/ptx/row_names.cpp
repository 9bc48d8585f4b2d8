// Normalises the spelling of opcodes.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/row_names.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"

namespace glint::frontend::ptx {

std::string joined(const Words& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ".") + word;
  return out;
}

bool has_word(const Words& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

namespace {

template <size_t kCount>
bool is_one_of(const std::string& word, const std::array<std::string_view, kCount>& list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

int row_of(const Words& words) {
  return isa::find_op(joined(words));
}

bool is_float(const std::string& word) {
  const auto type = type_of(word);
  return type && type->kind == 'f';
}

// Returns the place of a modifier of floating-point arithmetic in the canonical order, which is that of PTX.
int rank_of(const std::string& word) {
  static constexpr std::array<std::string_view, 15> kOrder{"approx", "full",    "rn",  "rz",        "rm",
                                                           "rp",     "rna",     "ftz", "sat",       "relu",
                                                           "NaN",    "xorsign", "abs", "satfinite", "oob"};
  const auto at = std::find(kOrder.begin(), kOrder.end(), word);
  if (at == kOrder.end()) return 100;  // Types come last.
  const int rank = int(at - kOrder.begin());
  return rank >= 2 && rank <= 6 ? 2 : rank;
}

Words with_float_defaults(Words words) {
  static constexpr std::array<std::string_view, 7> kArithmetic{"add", "sub", "mul", "mad",
                                                               "fma", "min", "max"};
  if (words.size() < 2 || !is_one_of(words[0], kArithmetic) || !is_float(words.back())) return words;
  if (words[0] == "mad") words[0] = "fma";
  const bool rounds = words[0] != "min" && words[0] != "max";
  const bool has_rounding =
      std::any_of(words.begin() + 1, words.end(), [](const std::string& w) { return rank_of(w) == 2; });
  if (rounds && !has_rounding) words.insert(words.begin() + 1, "rn");
  std::stable_sort(words.begin() + 1, words.end(),
                   [](const std::string& a, const std::string& b) { return rank_of(a) < rank_of(b); });
  return words;
}

// Gives comparisons that mean the same one name: setp.lo.u32 becomes setp.lt.u32, and so on.
Words with_common_comparison(Words words) {
  static constexpr std::pair<std::string_view, std::string_view> kSame[] = {
      {"lo", "lt"}, {"ls", "le"}, {"hi", "gt"}, {"hs", "ge"}};
  if (words.size() > 2 && (words[0] == "setp" || words[0] == "set"))
    for (const auto& [unsigned_name, name] : kSame)
      if (words[1] == unsigned_name) words[1] = name;
  return words;
}

// Returns true for ops whose result does not depend on how the bits of their first type are interpreted.
bool ignores_type(const Words& words) {
  static constexpr std::array<std::string_view, 16> kBitOps{"mov",  "selp", "slct", "and", "or",  "xor",
                                                            "not",  "cnot", "shl",  "add", "sub", "addc",
                                                            "subc", "popc", "clz",  "brev"};
  if (is_one_of(words[0], kBitOps)) return true;
  if (words[0] == "mul" || words[0] == "mad" || words[0] == "madc") return has_word(words, "lo");
  if (words[0] == "setp" || words[0] == "set")
    return words[1] == "eq" || words[1] == "ne" || words.back()[0] == 'b';
  return words[0] == "shr" && words.back()[0] == 'b';
}

int find_with_other_types(const Words& words) {
  if (words.size() < 2 || !ignores_type(words)) return -1;
  for (size_t i = 1; i < words.size(); ++i) {
    const auto type = type_of(words[i]);
    if (!type || type->kind == 'p') continue;
    if (words[i] != type->kind + std::to_string(type->bits)) return -1;  // s16x2 and such
    const bool integers_only = words[0] != "mov" && words[0] != "selp" && words[0] != "slct";
    if (integers_only && type->kind == 'f') return -1;
    for (char kind : {'b', 'u', 's', 'f'}) {
      Words other = words;
      other[i] = kind + std::to_string(type->bits);
      if (const int row = row_of(other); row >= 0) return row;
    }
    // A register holds 16 bits as well as 32, and a move or a selection only sees bits.
    if (type->bits == 16 && !integers_only && words[0] != "slct") {
      Words wide = words;
      wide[i] = "b32";
      if (const int row = row_of(wide); row >= 0) return row;
    }
    return -1;
  }
  return -1;
}

}  // namespace

int find_row(const Words& words) {
  if (const int row = row_of(words); row >= 0) return row;
  const Words canonical = with_common_comparison(with_float_defaults(words));
  if (const int row = row_of(canonical); row >= 0) return row;
  if (const int row = find_with_other_types(canonical); row >= 0) return row;
  // These words are hints to the compiler and have no meaning of their own.
  Words plain;
  for (const std::string& word : canonical)
    if (word != "aligned" && word != "uni" && word != "cta") plain.push_back(word);
  return plain.size() != words.size() ? find_row(plain) : -1;
}

std::optional<MemoryForm> memory_form(const Words& words) {
  MemoryForm form;
  form.op = words[0] == "ldu" ? "ld" : words[0];
  if (form.op != "ld" && form.op != "st" && form.op != "atom" && form.op != "red") return {};
  static constexpr std::array<std::string_view, 6> kSpaces{"global", "shared", "local",
                                                           "const",  "param",  "generic"};
  static constexpr std::array<std::string_view, 14> kFunctions{
      "add", "min", "max", "inc", "dec", "and", "or", "xor", "exch", "cas", "noftz", "ftz", "rn", "sat"};
  // These words say how caches and other threads take part, which changes nothing here.
  static constexpr std::array<std::string_view, 14> kHints{
      "weak", "cta", "cluster", "gpu", "sys", "nc", "ca", "cg", "cs", "lu", "cv", "wb", "wt", "unified"};
  for (size_t i = 1; i < words.size(); ++i) {
    const std::string head = words[i].substr(0, words[i].find("::"));
    if (is_one_of(head, kSpaces)) {
      form.space = head == "generic" ? "" : head;
    } else if (words[i] == "v2" || words[i] == "v4" || words[i] == "v8") {
      form.vector = uint32_t(words[i][1] - '0');
    } else if (form.op != "ld" && form.op != "st" && is_one_of(words[i], kFunctions)) {
      form.function.push_back(words[i]);
    } else if (const auto type = type_of(words[i])) {
      form.type = *type;
      form.type_name = words[i];
    } else if (words[i] == "volatile" || words[i] == "relaxed" || words[i] == "mmio") {
      form.is_strong = true;
    } else if (words[i] == "acq_rel" || words[i] == "sc") {
      form.acquires = form.releases = true;
    } else if (words[i] == "acquire" || words[i] == "release") {
      (words[i] == "acquire" ? form.acquires : form.releases) = true;
    } else if (!is_one_of(words[i], kHints) && head != "L1" && head != "L2" && head != "level") {
      return {};
    }
  }
  return form.type_name.empty() ? std::nullopt : std::optional(form);
}

int find_access_row(const MemoryForm& form, uint32_t parts) {
  const uint32_t bits = form.type.bits;
  Words words{form.op};
  if (!form.space.empty()) words.push_back(form.space);
  if (parts > 1) words.push_back("v" + std::to_string(parts));
  words.emplace_back();
  const bool is_signed = form.type.kind == 's' && form.op == "ld";
  const char kinds[] = {is_signed && bits < 32 ? 's' : 'b', is_signed ? 's' : 'u', 'b'};
  for (int generic = 0; generic < 2; ++generic) {
    for (char kind : kinds) {
      words.back() = kind + std::to_string(bits);
      if (is_signed && bits < 32 && kind == 'b') continue;
      if (const int row = row_of(words); row >= 0) return row;
    }
    if (form.space.empty()) words.insert(words.begin() + 1, "generic");
  }
  return -1;
}

int find_atomic_row(const MemoryForm& form) {
  for (const std::string& op : {form.op, std::string("atom")})
    for (const std::string& space : {form.space, std::string(form.space.empty() ? "generic" : form.space)}) {
      Words words{op};
      if (!space.empty()) words.push_back(space);
      words.insert(words.end(), form.function.begin(), form.function.end());
      words.push_back(form.type_name);
      if (const int row = row_of(words); row >= 0) return row;
      const std::string& function = form.function.empty() ? form.op : form.function[0];
      if (form.type.kind == 'f' || function == "min" || function == "max") continue;
      for (char kind : {'b', 'u', 's'}) {
        words.back() = kind + std::to_string(form.type.bits);
        if (const int row = row_of(words); row >= 0) return row;
      }
    }
  return -1;
}

std::string nearest_row(const std::string& name) {
  std::vector<std::string> names;
  for (const isa::OpRow& row : isa::op_table()) names.emplace_back(row.name);
  return nearest(name, names);
}

}  // namespace glint::frontend::ptx
