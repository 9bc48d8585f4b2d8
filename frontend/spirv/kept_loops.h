// Keeps loops that nothing leads out of, which the optimiser would remove as code without an effect.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace glint::frontend {

// SPIRV-Tools removes a loop without an effect, also one that never ends, and a shader that hangs on a GPU
// would end here. with_kept_loops() puts an instruction with an effect into each such loop, in the form that
// with_known_prints() gives to prints. without_marks() removes the instructions again. Loops count only when
// their conditions are constants.
std::vector<uint32_t> with_kept_loops(const std::vector<uint32_t>& words);
std::vector<uint32_t> without_marks(const std::vector<uint32_t>& words);

}  // namespace glint::frontend
