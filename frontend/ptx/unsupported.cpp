// Sorts opcodes into the parts of PTX that Glint does not have.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/unsupported.h"

#include <algorithm>
#include <map>

namespace glint::frontend::ptx {
namespace {

constexpr const char* kHandles = "questions about handles";
constexpr const char* kTensors = "asynchronous ops of tensor cores (there are mma and wmma)";
constexpr const char* kBulk = "bulk copies, and the transactions that barriers wait for";
constexpr const char* kClusters = "clusters of more than one block";

const std::map<std::string, const char*, std::less<>>& part_by_op() {
  static const std::map<std::string, const char*, std::less<>> kParts{{"istypep", kHandles},
                                                                      {"wgmma", kTensors},
                                                                      {"tcgen05", kTensors},
                                                                      {"mapa", kClusters},
                                                                      {"getctarank", kClusters}};
  return kParts;
}

}  // namespace

std::string unsupported_part(const Words& words) {
  if (const auto part = part_by_op().find(words[0]); part != part_by_op().end()) return part->second;
  if ((words[0] == "st" || words[0] == "red") && has_word(words, "async")) return kBulk;
  if (words[0] == "cp" && (has_word(words, "bulk") || words[1] == "reduce")) return kBulk;
  if (words[0] == "mbarrier" && (has_word(words, "expect_tx") || has_word(words, "complete_tx")))
    return kBulk;
  if (words[0] == "mbarrier" && has_word(words, "shared::cluster")) return kClusters;
  if (words[0] == "barrier" && has_word(words, "cluster")) return kClusters;
  return {};
}

bool is_part_selector(const std::string& element) {
  return element == "h0" || element == "h1" ||
         (element.size() == 2 && element[0] == 'b' && element[1] >= '0' && element[1] <= '3');
}

}  // namespace glint::frontend::ptx
