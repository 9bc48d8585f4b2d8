// Defines loads and stores, whose handlers form addresses while the machine moves the data, and generic
// addresses.
// SPDX-License-Identifier: Apache-2.0
#include "isa/generic_address.h"
#include "isa/op_makers.h"
#include "isa/ops/addresses.h"
#include "isa/ops/families.h"
#include "isa/ops/word.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Describes a shape of data: PTX's type and vector suffix, and the operand that holds it.
struct Shape {
  std::string_view suffix, what;
  uint8_t bytes, count;
  bool sign_extend;
  OperandKind load;
  // This is the operand of a store. With None, the type has only loads, because stores use the untyped bits.
  OperandKind store;
};
constexpr Shape kShapes[] = {
    {"b8", "a byte, zero-extended,", 1, 1, false, Dst32, Src32},
    {"u8", "a byte, zero-extended,", 1, 1, false, Dst32, None},
    {"s8", "a byte, sign-extended,", 1, 1, true, Dst32, None},
    {"b16", "2 bytes, zero-extended,", 2, 1, false, Dst32, Src32},
    {"u16", "2 bytes, zero-extended,", 2, 1, false, Dst32, None},
    {"s16", "2 bytes, sign-extended,", 2, 1, true, Dst32, None},
    {"b32", "4 bytes", 4, 1, false, Dst32, Src32},
    {"b64", "8 bytes", 8, 1, false, Dst64, Src64},
    {"v2.b8", "two bytes, zero-extended,", 1, 2, false, DstVec2, SrcVec2},
    {"v2.u8", "two bytes, zero-extended,", 1, 2, false, DstVec2, None},
    {"v2.s8", "two bytes, sign-extended,", 1, 2, true, DstVec2, None},
    {"v4.b8", "four bytes, zero-extended,", 1, 4, false, DstVec4, SrcVec4},
    {"v4.u8", "four bytes, zero-extended,", 1, 4, false, DstVec4, None},
    {"v4.s8", "four bytes, sign-extended,", 1, 4, true, DstVec4, None},
    {"v2.b16", "two half words, zero-extended,", 2, 2, false, DstVec2, SrcVec2},
    {"v2.u16", "two half words, zero-extended,", 2, 2, false, DstVec2, None},
    {"v2.s16", "two half words, sign-extended,", 2, 2, true, DstVec2, None},
    {"v4.b16", "four half words, zero-extended,", 2, 4, false, DstVec4, SrcVec4},
    {"v4.u16", "four half words, zero-extended,", 2, 4, false, DstVec4, None},
    {"v4.s16", "four half words, sign-extended,", 2, 4, true, DstVec4, None},
    {"v2.b32", "two words", 4, 2, false, DstVec2, SrcVec2},
    {"v4.b32", "four words", 4, 4, false, DstVec4, SrcVec4},
    {"v2.b64", "two double words, each low half first,", 4, 4, false, DstVec4, SrcVec4},
};

struct Place {
  Space space;
  std::string_view suffix, what;
  bool stores;
};
constexpr Place kPlaces[] = {
    {Space::Global, ".global", "global memory", true},
    {Space::Shared, ".shared", "the block's shared memory", true},
    {Space::Local, ".local", "the lane's stack", true},
    {Space::Const, ".const", "the constant bank", false},
    {Space::Param, ".param", "the kernel's parameters", false},
    {Space::Generic, "", "the space of a generic address", true},
};

constexpr Handler handler_of(bool is_wide, int slot) {
  if (is_wide)
    return slot == 0   ? &form_addresses<uint64_t, 0>
           : slot == 1 ? &form_addresses<uint64_t, 1>
           : slot == 2 ? &form_addresses<uint64_t, 2>
                       : &form_addresses<uint64_t, 4>;
  return slot == 0   ? &form_addresses<uint32_t, 0>
         : slot == 1 ? &form_addresses<uint32_t, 1>
         : slot == 2 ? &form_addresses<uint32_t, 2>
                     : &form_addresses<uint32_t, 4>;
}

constexpr size_t kNumStores = [] {
  size_t n = 0;
  for (const Shape& shape : kShapes) n += shape.store != None;
  return n;
}();
constexpr size_t kNumStorePlaces = [] {
  size_t n = 0;
  for (const Place& place : kPlaces) n += place.stores;
  return n;
}();
constexpr size_t kNumAccesses = std::size(kPlaces) * std::size(kShapes) + kNumStorePlaces * kNumStores;

// Calls `visit(place, shape, store)` for every access that exists, in the order of the table.
template <class Visit>
constexpr void each_access(Visit&& visit) {
  for (const Place& place : kPlaces) {
    for (const Shape& shape : kShapes) visit(place, shape, false);
    if (!place.stores) continue;
    for (const Shape& shape : kShapes)
      if (shape.store != None) visit(place, shape, true);
  }
}

constexpr auto kNames = [] {
  std::array<Word, kNumAccesses> out{};
  size_t n = 0;
  each_access([&](const Place& place, const Shape& shape, bool store) {
    out[n++] = Word{store ? "st" : "ld", place.suffix, ".", shape.suffix};
  });
  return out;
}();
// A store ignores how a load would extend its parts.
constexpr std::string_view bytes_of(const Shape& shape, bool store) {
  return store ? shape.what.substr(0, shape.what.find(',')) : shape.what;
}
constexpr auto kSentences = [] {
  std::array<Word, kNumAccesses> out{};
  size_t n = 0;
  each_access([&](const Place& place, const Shape& shape, bool store) {
    out[n++] = Word{store ? "Stores " : "Loads ", bytes_of(shape, store), store ? " to " : " from ",
                    place.what, "."};
  });
  return out;
}();

constexpr OpRow access_row(size_t n, const Place& place, const Shape& shape, bool store) {
  const bool is_wide = place.space == Space::Global || place.space == Space::Generic;
  const bool is_constant = place.space == Space::Const || place.space == Space::Param;
  const OperandKind address = is_wide ? Address64 : Address32;
  OpRow row =
      effect_op(kNames[n].view(), Class::Mem, is_constant ? Unit::Const : Unit::Lsu,
                store ? Effect::Store : Effect::Load,
                store ? Operands{address, shape.store} : Operands{shape.load, address}, kSentences[n].view());
  row.memory = {place.space, shape.bytes, shape.count, shape.sign_extend};
  row.run = handler_of(is_wide, store ? 0 : slots_of(shape.load));
  return row;
}

// Converts generic addresses to and from those of a space. Bits outside the window's 32 are ignored.
template <Space kSpace>
constexpr OpRow to_generic(std::string_view name, std::string_view doc) {
  constexpr uint64_t kWindow = window_of(kSpace);
  return unary<uint64_t>(name, Unit::Int, doc, [](uint64_t a) { return a + kWindow; },
                         {{{0}, kWindow}, {{0x1234}, kWindow + 0x1234}});
}
template <Space kSpace>
constexpr OpRow from_generic(std::string_view name, std::string_view doc) {
  constexpr uint64_t kWindow = window_of(kSpace);
  return unary<uint64_t>(name, Unit::Int, doc, [](uint64_t a) { return a - kWindow; },
                         {{{kWindow}, 0}, {{kWindow + 0x1234}, 0x1234}});
}
// Tests without a branch: it is space_of() as a comparison of the upper halves.
template <Space kSpace>
constexpr OpRow is_space(std::string_view name, std::string_view doc) {
  constexpr uint64_t kWindow = window_of(kSpace);
  if constexpr (kSpace == Space::Global)
    return value_op<uint64_t>(name, Unit::Predicate, doc,
                              [](uint64_t a) -> bool {
                                const uint64_t high = a >> 32;
                                return (high < kConstWindow >> 32) | (high > kLocalWindow >> 32);
                              },
                              {{{0x1'0000'0000}, 1}, {{kSharedWindow + 4}, 0}, {{kConstWindow - 1}, 1}});
  else
    return value_op<uint64_t>(name, Unit::Predicate, doc,
                              [](uint64_t a) -> bool {
                                const bool in_window = a >> 32 == kWindow >> 32;
                                return in_window & (uint32_t(a) >= uint32_t(kWindow));
                              },
                              {{{kWindow + 4}, 1}, {{0x1'0000'0000}, 0}, {{kLocalWindow + kWindowBytes}, 0}});
}

constexpr OpRow kAddressRows[] = {
    to_generic<Space::Global>("cvta.global.u64", "Converts a global address to a generic one."),
    to_generic<Space::Shared>("cvta.shared.u64", "Converts a shared address to a generic one."),
    to_generic<Space::Local>("cvta.local.u64", "Converts a local address to a generic one."),
    to_generic<Space::Const>("cvta.const.u64", "Converts an address in the constant bank to a generic one."),
    to_generic<Space::Param>("cvta.param.u64",
                             "Converts the address of a kernel's parameter to a generic one."),
    from_generic<Space::Global>("cvta.to.global.u64",
                                "Converts a generic address in global memory to a global one."),
    from_generic<Space::Shared>("cvta.to.shared.u64",
                                "Converts a generic address in shared memory to a shared one."),
    from_generic<Space::Local>("cvta.to.local.u64",
                               "Converts a generic address in local memory to a local one."),
    from_generic<Space::Const>("cvta.to.const.u64",
                               "Converts a generic address in the constant bank to an address of the bank."),
    from_generic<Space::Param>("cvta.to.param.u64",
                               "Converts a generic address of a parameter to the parameter's address."),
    is_space<Space::Global>("isspacep.global", "Tells whether a generic address is in global memory."),
    is_space<Space::Shared>("isspacep.shared", "Tells whether a generic address is in shared memory."),
    is_space<Space::Local>("isspacep.local", "Tells whether a generic address is in local memory."),
    is_space<Space::Const>("isspacep.const", "Tells whether a generic address is in the constant bank."),
    is_space<Space::Param>("isspacep.param",
                           "Tells whether a generic address is that of a kernel's parameter."),
};

constexpr auto kRows = [] {
  std::array<OpRow, kNumAccesses + std::size(kAddressRows)> out{};
  size_t n = 0;
  each_access([&](const Place& place, const Shape& shape, bool store) {
    out[n] = access_row(n, place, shape, store);
    ++n;
  });
  for (const OpRow& row : kAddressRows) out[n++] = row;
  return out;
}();

}  // namespace

RowList memory_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
