// Loads and stores: their handlers form addresses, the machine moves the data.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Writes the addresses of all lanes: those outside exec mean nothing to anybody. Operand kSlot is the base.
// 64-bit bases wrap modulo 2^64, 32-bit bases modulo 2^32.
template <class Base, int kSlot>
[[gnu::flatten]] void form_addresses(Warp& warp, const Inst& inst) {
  const Source<Base> base(warp, *(&inst.operand.front() + kSlot));
  Address* const out = &warp.access.address.front();
  const Base displacement = Base(int64_t(inst.imm));
  all_lanes([&](int i) { out[i] = Address(Base(base.at(i) + displacement)); });
}

constexpr bool is_wide(Space space) {
  return space == Space::Global;
}

template <Space kSpace, int kSlot>
constexpr Handler handler_of() {
  if constexpr (is_wide(kSpace))
    return &form_addresses<uint64_t, kSlot>;
  else
    return &form_addresses<uint32_t, kSlot>;
}

template <Space kSpace>
constexpr OpRow access_row(std::string_view name, Effect effect, Memory memory, Operands operands,
                           Handler run, std::string_view doc) {
  OpRow row =
      effect_op(name, Class::Mem, kSpace == Space::Const ? Unit::Const : Unit::Lsu, effect, operands, doc);
  row.memory = memory;
  row.memory.space = kSpace;
  row.run = run;
  return row;
}

// `kind` holds the data (a destination of 1, 2 or 4 slots); the address follows it.
template <Space kSpace, OperandKind kKind>
constexpr OpRow load(std::string_view name, Memory memory, std::string_view doc) {
  return access_row<kSpace>(name, Effect::Load, memory, {kKind, is_wide(kSpace) ? Address64 : Address32},
                            handler_of<kSpace, slots_of(kKind)>(), doc);
}
// The address stands first.
template <Space kSpace, OperandKind kKind>
constexpr OpRow store(std::string_view name, Memory memory, std::string_view doc) {
  return access_row<kSpace>(name, Effect::Store, memory, {is_wide(kSpace) ? Address64 : Address32, kKind},
                            handler_of<kSpace, 0>(), doc);
}

constexpr Memory parts(uint8_t bytes, uint8_t count = 1, bool sign_extend = false) {
  return {Space::None, bytes, count, sign_extend};
}

constexpr OpRow kRows[] = {
    load<Space::Global, Dst32>("ld.global.b32", parts(4), "Loads 4 bytes of global memory."),
    load<Space::Global, Dst32>("ld.global.u8", parts(1), "Loads a byte of global memory, zero-extended."),
    load<Space::Global, Dst32>("ld.global.s8", parts(1, 1, true),
                               "Loads a byte of global memory, sign-extended."),
    load<Space::Global, Dst32>("ld.global.u16", parts(2), "Loads 2 bytes of global memory, zero-extended."),
    load<Space::Global, Dst32>("ld.global.s16", parts(2, 1, true),
                               "Loads 2 bytes of global memory, sign-extended."),
    load<Space::Global, DstVec2>("ld.global.v2.b32", parts(4, 2), "Loads two words of global memory."),
    load<Space::Global, DstVec4>("ld.global.v4.b32", parts(4, 4), "Loads four words of global memory."),
    load<Space::Global, Dst64>("ld.global.b64", parts(8), "Loads 8 bytes of global memory."),
    store<Space::Global, Src32>("st.global.b32", parts(4), "Stores 4 bytes to global memory."),
    store<Space::Global, Src32>("st.global.b8", parts(1), "Stores the low byte to global memory."),
    store<Space::Global, Src32>("st.global.b16", parts(2), "Stores the low 2 bytes to global memory."),
    store<Space::Global, SrcVec2>("st.global.v2.b32", parts(4, 2), "Stores two words to global memory."),
    store<Space::Global, SrcVec4>("st.global.v4.b32", parts(4, 4), "Stores four words to global memory."),
    store<Space::Global, Src64>("st.global.b64", parts(8), "Stores 8 bytes to global memory."),
    load<Space::Local, Dst32>("ld.local.b32", parts(4), "Loads 4 bytes of the lane's stack."),
    load<Space::Local, DstVec2>("ld.local.v2.b32", parts(4, 2), "Loads two words of the lane's stack."),
    load<Space::Local, DstVec4>("ld.local.v4.b32", parts(4, 4), "Loads four words of the lane's stack."),
    load<Space::Local, Dst64>("ld.local.b64", parts(8), "Loads 8 bytes of the lane's stack."),
    store<Space::Local, Src32>("st.local.b32", parts(4), "Stores 4 bytes to the lane's stack."),
    store<Space::Local, SrcVec2>("st.local.v2.b32", parts(4, 2), "Stores two words to the lane's stack."),
    store<Space::Local, SrcVec4>("st.local.v4.b32", parts(4, 4), "Stores four words to the lane's stack."),
    store<Space::Local, Src64>("st.local.b64", parts(8), "Stores 8 bytes to the lane's stack."),
    load<Space::Const, Dst32>("ld.const.b32", parts(4), "Loads 4 bytes of the constant bank."),
    load<Space::Const, DstVec2>("ld.const.v2.b32", parts(4, 2), "Loads two words of the constant bank."),
    load<Space::Const, DstVec4>("ld.const.v4.b32", parts(4, 4), "Loads four words of the constant bank."),
    load<Space::Const, Dst64>("ld.const.b64", parts(8), "Loads 8 bytes of the constant bank."),
};

}  // namespace

RowList memory_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
