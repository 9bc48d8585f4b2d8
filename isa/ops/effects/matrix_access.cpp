// Defines loads and stores of matrices of 8x8 half words in shared memory. The machine does all the work.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/addresses.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// A lane gives the address of a row, which has 16 bytes.
constexpr OpRow access(std::string_view name, uint8_t matrices, bool is_transposed, bool store,
                       std::string_view doc) {
  const OperandKind to = matrices == 4 ? DstVec4 : matrices == 2 ? DstVec2 : Dst32;
  const OperandKind from = matrices == 4 ? SrcVec4 : matrices == 2 ? SrcVec2 : Src32;
  OpRow row = effect_op(name, Class::Mem, Unit::Lsu, store ? Effect::Store : Effect::Load,
                        store ? Operands{Address32, from} : Operands{to, Address32}, doc);
  row.memory = {Space::Shared, 4, 4, false, matrices, is_transposed};
  row.run = store           ? &form_addresses<uint32_t, 0>
            : matrices == 4 ? &form_addresses<uint32_t, 4>
            : matrices == 2 ? &form_addresses<uint32_t, 2>
                            : &form_addresses<uint32_t, 1>;
  return row;
}
constexpr OpRow load(std::string_view name, uint8_t matrices, std::string_view doc) {
  return access(name, matrices, name.find(".trans") != name.npos, false, doc);
}
constexpr OpRow store(std::string_view name, uint8_t matrices, std::string_view doc) {
  return access(name, matrices, name.find(".trans") != name.npos, true, doc);
}

constexpr OpRow kRows[] = {
    load("ldmatrix.sync.aligned.m8n8.x1.shared.b16", 1, "Loads a matrix, whose rows lanes 0 to 7 name."),
    load("ldmatrix.sync.aligned.m8n8.x2.shared.b16", 2, "Loads two matrices, whose rows lanes 0 to 15 name."),
    load("ldmatrix.sync.aligned.m8n8.x4.shared.b16", 4, "Loads four matrices, whose rows all lanes name."),
    load("ldmatrix.sync.aligned.m8n8.x1.trans.shared.b16", 1,
         "Loads a matrix, whose rows lanes 0 to 7 name, with rows and columns exchanged."),
    load("ldmatrix.sync.aligned.m8n8.x2.trans.shared.b16", 2,
         "Loads two matrices, whose rows lanes 0 to 15 name, with rows and columns exchanged."),
    load("ldmatrix.sync.aligned.m8n8.x4.trans.shared.b16", 4,
         "Loads four matrices, whose rows all lanes name, with rows and columns exchanged."),
    store("stmatrix.sync.aligned.m8n8.x1.shared.b16", 1, "Stores a matrix, whose rows lanes 0 to 7 name."),
    store("stmatrix.sync.aligned.m8n8.x2.shared.b16", 2,
          "Stores two matrices, whose rows lanes 0 to 15 name."),
    store("stmatrix.sync.aligned.m8n8.x4.shared.b16", 4, "Stores four matrices, whose rows all lanes name."),
    store("stmatrix.sync.aligned.m8n8.x1.trans.shared.b16", 1,
          "Stores a matrix, whose rows lanes 0 to 7 name, with rows and columns exchanged."),
    store("stmatrix.sync.aligned.m8n8.x2.trans.shared.b16", 2,
          "Stores two matrices, whose rows lanes 0 to 15 name, with rows and columns exchanged."),
    store("stmatrix.sync.aligned.m8n8.x4.trans.shared.b16", 4,
          "Stores four matrices, whose rows all lanes name, with rows and columns exchanged."),
};

}  // namespace

RowList matrix_access_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
