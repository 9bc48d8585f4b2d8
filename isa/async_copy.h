// Names what the rows with Effect::CopyGroup ask for, in their OpRow::detail.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::isa {

// Names the kinds of Effect::CopyGroup. Commit makes one group of the copies that the threads have begun
// since the last one. Wait waits until at most as many groups are under way as its operand says, the youngest
// ones.
enum class CopyGroupKind : uint16_t { Commit, Wait };

}  // namespace glint::isa
