// Lists the oracles of ops with effects. An oracle knows what an op does from the words of its name alone,
// and shares no code with the executor.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "isa/op_row.h"

namespace glint::test {

// Runs the op of a row on both machines and compares all that it does. Returns the number of lanes that
// executed it, as the machine says.
using Oracle = uint64_t (*)(const isa::OpRow& row);

uint64_t check_access(const isa::OpRow& row);
uint64_t check_atomic(const isa::OpRow& row);
uint64_t check_copy(const isa::OpRow& row);
uint64_t check_control(const isa::OpRow& row);
uint64_t check_callable(const isa::OpRow& row);
uint64_t check_hit_object(const isa::OpRow& row);
uint64_t check_image_query(const isa::OpRow& row);
uint64_t check_matrix_access(const isa::OpRow& row);
uint64_t check_ray_query(const isa::OpRow& row);
uint64_t check_ray_tracing(const isa::OpRow& row);
uint64_t check_surface(const isa::OpRow& row);
uint64_t check_texture(const isa::OpRow& row);

// Names an oracle by its file, which is what isa::test_of() gives.
struct OracleFile {
  std::string_view file;
  Oracle check;
};
inline constexpr OracleFile kOracles[] = {
    {"tests/ops/access.cpp", &check_access},
    {"tests/ops/atomic.cpp", &check_atomic},
    {"tests/ops/callable.cpp", &check_callable},
    {"tests/ops/control.cpp", &check_control},
    {"tests/ops/copy.cpp", &check_copy},
    {"tests/ops/hit_object.cpp", &check_hit_object},
    {"tests/ops/image_query.cpp", &check_image_query},
    {"tests/ops/matrix_access.cpp", &check_matrix_access},
    {"tests/ops/ray_query.cpp", &check_ray_query},
    {"tests/ops/ray_tracing.cpp", &check_ray_tracing},
    {"tests/ops/surface.cpp", &check_surface},
    {"tests/ops/texture.cpp", &check_texture},
};

}  // namespace glint::test
