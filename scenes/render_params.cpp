// Lists the values of a frame's parameters.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/render_params.h"

namespace glint::scenes {

std::vector<std::pair<std::string, uint64_t>> values_of(const RenderParams& params) {
  std::vector<std::pair<std::string, uint64_t>> out;
  for (const RenderParam& p : RenderParams::params())
    if (!p.is_optional || params.*p.field != 0) out.emplace_back(p.key, params.*p.field);
  return out;
}

}  // namespace glint::scenes
