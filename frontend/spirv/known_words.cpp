// Rewrites the languages of a module's sources.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/known_words.h"

#include <span>
#include <utility>

#include "frontend/spirv/known_positions.h"
#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

// SYCL. Source: unified1/spirv.h of SPIRV-Headers 1.3.239.
constexpr uint32_t kNewestLanguage = 7;

void forget_young_languages(std::vector<uint32_t>& spirv) {
  for_each_instruction(spirv, [&](spv::Op op, std::span<const uint32_t> w) {
    if (op == spv::Op::OpSource && w.size() > 1 && w[1] > kNewestLanguage)
      spirv[size_t(w.data() - spirv.data()) + 1] = uint32_t(spv::SourceLanguage::Unknown);
  });
}

}  // namespace

std::vector<uint32_t> with_known_words(std::vector<uint32_t> spirv) {
  forget_young_languages(spirv);
  return with_known_positions(std::move(spirv));
}

}  // namespace glint::frontend
