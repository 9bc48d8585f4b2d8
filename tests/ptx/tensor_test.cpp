// Tests products of matrices: what kernels with mma, ldmatrix and wmma compute on both machines, how long
// they take, and which forms are refused.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

namespace {

// Returns the bits of a small whole number in a type of PTX.
uint64_t bits_of(const std::string& type, int value) {
  if (type == "f16") {
    const uint32_t single = std::bit_cast<uint32_t>(float(value));
    return value == 0 ? 0
                      : (single >> 16 & 0x8000) | ((single >> 23 & 255) - 112) << 10 | (single >> 13 & 0x3ff);
  }
  if (type == "bf16") return std::bit_cast<uint32_t>(float(value)) >> 16;
  if (type == "tf32" || type == "f32") return std::bit_cast<uint32_t>(float(value));
  if (type == "f64") return std::bit_cast<uint64_t>(double(value));
  return uint32_t(value);
}
uint32_t bytes_of(const std::string& type) {
  return type == "f64" ? 8 : type.ends_with("32") ? 4 : type.ends_with("16") ? 2 : 1;
}

// Holds a matrix of small whole numbers by rows, and its bytes in either layout.
struct Numbers {
  uint32_t rows, columns;
  std::vector<int> at;
  Numbers(uint32_t r, uint32_t c, uint32_t seed, int least, int most) : rows(r), columns(c) {
    for (uint32_t i = 0; i < r * c; ++i) {
      seed = seed * 1664525 + 1013904223;
      at.push_back(least + int((seed >> 16) % uint32_t(most - least + 1)));
    }
  }
  int operator()(uint32_t r, uint32_t c) const { return at[r * columns + c]; }
  // Lines lie `stride` elements apart.
  std::vector<uint8_t> bytes(const std::string& type, bool by_rows, uint32_t stride) const {
    const uint32_t size = bytes_of(type);
    std::vector<uint8_t> out(size_t(by_rows ? rows : columns) * stride * size);
    for (uint32_t r = 0; r < rows; ++r)
      for (uint32_t c = 0; c < columns; ++c) {
        const uint64_t value = bits_of(type, (*this)(r, c));
        std::memcpy(&out[size_t((by_rows ? r * stride + c : c * stride + r)) * size], &value, size);
      }
    return out;
  }
};

int product(const Numbers& a, const Numbers& b, const Numbers& c, uint32_t row, uint32_t column) {
  int sum = c(row, column);
  for (uint32_t k = 0; k < a.columns; ++k) sum += a(row, k) * b(k, column);
  return sum;
}

// Multiplies 32x32 halves of A (by rows) and B (by columns) in each of two blocks, of different rows of A.
// Each of four warps has 16x16 sums.
const std::string kTiles = kHead + R"(
.visible .entry k(.param .u64 pa, .param .u64 pb, .param .u64 pc)
{
.reg .b32 %t, %lane, %warp, %block, %r<60>; .reg .b64 %a, %b, %c, %rd<20>; .reg .f32 %f<16>; .reg .pred %p;
.shared .align 16 .b8 sa[2048];
.shared .align 16 .b8 sb[2048];
ld.param.u64 %a, [pa]; ld.param.u64 %b, [pb]; ld.param.u64 %c, [pc];
mov.u32 %t, %tid.x; and.b32 %lane, %t, 31; shr.u32 %warp, %t, 5; mov.u32 %block, %ctaid.x;
// Each thread copies 16 bytes of either tile.
mul.wide.u32 %rd1, %block, 2048; add.u64 %a, %a, %rd1; mul.wide.u32 %rd1, %t, 16;
add.u64 %rd2, %a, %rd1; ld.global.v4.b32 {%r1,%r2,%r3,%r4}, [%rd2];
add.u64 %rd2, %b, %rd1; ld.global.v4.b32 {%r5,%r6,%r7,%r8}, [%rd2];
mov.u32 %r9, sa; mad.lo.u32 %r10, %t, 16, %r9; st.shared.v4.b32 [%r10], {%r1,%r2,%r3,%r4};
mov.u32 %r11, sb; mad.lo.u32 %r12, %t, 16, %r11; st.shared.v4.b32 [%r12], {%r5,%r6,%r7,%r8};
bar.sync 0;
// Rows 16 * (warp / 2) of A and columns 16 * (warp % 2) of B.
shr.u32 %r13, %warp, 1; shl.b32 %r13, %r13, 4; and.b32 %r14, %warp, 1; shl.b32 %r14, %r14, 4;
// Of A, lane names row lane % 16 at half words 8 * (lane / 16).
and.b32 %r15, %lane, 15; add.u32 %r15, %r15, %r13; mad.lo.u32 %r15, %r15, 64, %r9;
and.b32 %r16, %lane, 16; add.u32 %r15, %r15, %r16;
// Of B, lane names column lane % 8 + 8 * (lane / 16) at half words 8 * (lane / 8 % 2).
and.b32 %r17, %lane, 7; shr.u32 %r18, %lane, 1; and.b32 %r18, %r18, 8; add.u32 %r17, %r17, %r18;
add.u32 %r17, %r17, %r14; mad.lo.u32 %r17, %r17, 64, %r11; and.b32 %r18, %lane, 8; shl.b32 %r18, %r18, 1;
add.u32 %r17, %r17, %r18;
mov.f32 %f0, 0f00000000; mov.f32 %f1, %f0; mov.f32 %f2, %f0; mov.f32 %f3, %f0;
mov.f32 %f4, %f0; mov.f32 %f5, %f0; mov.f32 %f6, %f0; mov.f32 %f7, %f0;
mov.u32 %r40, 0;
TURN:
ldmatrix.sync.aligned.m8n8.x4.shared.b16 {%r20,%r21,%r22,%r23}, [%r15];
ldmatrix.sync.aligned.m8n8.x4.shared.b16 {%r24,%r25,%r26,%r27}, [%r17];
mma.sync.aligned.m16n8k16.row.col.f32.f16.f16.f32 {%f0,%f1,%f2,%f3}, {%r20,%r21,%r22,%r23}, {%r24,%r25}, {%f0,%f1,%f2,%f3};
mma.sync.aligned.m16n8k16.row.col.f32.f16.f16.f32 {%f4,%f5,%f6,%f7}, {%r20,%r21,%r22,%r23}, {%r26,%r27}, {%f4,%f5,%f6,%f7};
add.u32 %r15, %r15, 32; add.u32 %r17, %r17, 32; add.u32 %r40, %r40, 1; setp.lt.u32 %p, %r40, 2; @%p bra TURN;
// Sums lie in rows lane / 4 and 8 below, columns 2 * (lane % 4) and its neighbour.
mad.lo.u32 %r41, %block, 32, %r13; shr.u32 %r42, %lane, 2; add.u32 %r41, %r41, %r42;
and.b32 %r43, %lane, 3; mad.lo.u32 %r43, %r43, 2, %r14; mad.lo.u32 %r41, %r41, 32, %r43;
mul.wide.u32 %rd3, %r41, 4; add.u64 %c, %c, %rd3;
st.global.v2.f32 [%c], {%f0,%f1}; st.global.v2.f32 [%c+1024], {%f2,%f3};
st.global.v2.f32 [%c+32], {%f4,%f5}; st.global.v2.f32 [%c+1056], {%f6,%f7};
ret;
}
)";

// Returns a kernel that loads fragments, multiplies, and stores the sums of the type `d`.
struct FragmentCase {
  std::string shape, factor, sum;
  uint32_t m, n, k, of_a, of_b, of_c;
};
std::string registers(const char* prefix, uint32_t count) {
  std::string out = "{";
  for (uint32_t i = 0; i < count; ++i) out += fmt::format("{}%{}{}", i ? "," : "", prefix, i);
  return out + "}";
}
std::string fragments_kernel(const FragmentCase& c, const char* of_a, const char* of_b, const char* of_c,
                             const char* space) {
  const std::string wide = c.factor == "f64" ? "f64" : "b32";
  const std::string at = *space ? "." + std::string(space) : "";
  const bool is_shared = at == ".shared";
  std::string text = kHead + ".visible .entry k(.param .u64 pa, .param .u64 pb, .param .u64 pc)\n{\n";
  text +=
      fmt::format(".reg .{0} %a<8>, %b<8>, %c<8>, %d<8>; .reg .b64 %rd<9>; .reg .b32 %r<9>, %s<4>;\n", wide);
  text += ".shared .align 32 .b8 sa[4096];\n.shared .align 32 .b8 sb[4096];\n.reg .pred %p;\n";
  text += "ld.param.u64 %rd0, [pa]; ld.param.u64 %rd1, [pb]; ld.param.u64 %rd2, [pc]; mov.u32 %r0, 48;\n";
  std::string from_a = "%rd0", from_b = "%rd1";
  if (is_shared) {
    text +=
        "mov.u32 %r1, %tid.x; mul.lo.u32 %r1, %r1, 4; cvt.u64.u32 %rd3, %r1; add.u64 %rd4, %rd0, %rd3; "
        "add.u64 "
        "%rd5, %rd1, %rd3; mov.u32 %r2, sa; mov.u32 %r3, sb; add.u32 %r4, %r2, %r1; add.u32 %r5, %r3, %r1; "
        "mov.u32 %r6, 0;\nCOPY: ld.global.b32 %r7, [%rd4]; st.shared.b32 [%r4], %r7; ld.global.b32 %r7, "
        "[%rd5]; "
        "st.shared.b32 [%r5], %r7; add.u64 %rd4, %rd4, 128; add.u64 %rd5, %rd5, 128; add.u32 %r4, %r4, 128; "
        "add.u32 %r5, %r5, 128; add.u32 %r6, %r6, 1; setp.lt.u32 %p, %r6, 32; @%p bra COPY;\nbar.sync 0;\n";
    from_a = "%r2";
    from_b = "%r3";
  }
  const std::string sums =
      c.factor == "f16" ? fmt::format("{0}.{0}", c.sum) : fmt::format("{1}.{0}.{0}.{1}", c.factor, c.sum);
  text += fmt::format("wmma.load.a.sync.aligned.{}.{}{}.{} {}, [{}], %r0;\n", of_a, c.shape, at, c.factor,
                      registers("a", c.of_a), from_a);
  text += fmt::format("wmma.load.b.sync.aligned.{}.{}{}.{} {}, [{}], %r0;\n", of_b, c.shape, at, c.factor,
                      registers("b", c.of_b), from_b);
  text += fmt::format("wmma.load.c.sync.aligned.{}.{}{}.{} {}, [%rd2], %r0;\n", of_c, c.shape,
                      is_shared ? ".global" : at, c.sum, registers("c", c.of_c));
  text += fmt::format("wmma.mma.sync.aligned.{}.{}.{}.{} {}, {}, {}, {};\n", of_a, of_b, c.shape, sums,
                      registers("d", c.of_c), registers("a", c.of_a), registers("b", c.of_b),
                      registers("c", c.of_c));
  text += fmt::format("wmma.store.d.sync.aligned.{}.{}{}.{} [%rd2], {}, %r0;\nret;\n}}\n", of_c, c.shape,
                      is_shared ? ".global" : at, c.sum, registers("d", c.of_c));
  return text;
}

std::string answer_to(const std::string& line) {
  return message_of(storing(line));
}
bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE(
    "tiles loaded with ldmatrix and multiplied with mma give the product on both machines and any threads") {
  const Numbers a(64, 32, 1, -4, 4), b(32, 32, 2, -4, 4), zero(64, 32, 3, 0, 0);
  std::vector<float> wanted;
  for (uint32_t row = 0; row < 64; ++row)
    for (uint32_t column = 0; column < 32; ++column)
      wanted.push_back(float(product(a, b, zero, row, column)));
  const pipeline::KernelGrid grid{{2, 1, 1}, {128, 1, 1}, 0};
  const auto with_matrices = [&](Launcher& k) -> Launcher& {
    return k.buffer(a.bytes("f16", true, 32))
        .buffer(b.bytes("f16", false, 32))
        .buffer(std::vector<float>(64 * 32));
  };
  pipeline::GpuParams two_cores;
  two_cores.cores = 2;
  Cycle cycles[2]{};
  for (uint32_t threads = 1; threads <= 2; ++threads) {
    Launcher functional(kTiles, "test.ptx", "k");
    with_matrices(functional).run_functional(grid, threads);
    CHECK(functional.read<float>(2, 64 * 32) == wanted);
    Launcher timed(kTiles, "test.ptx", "k");
    cycles[threads - 1] = with_matrices(timed).run_timing(grid, two_cores, threads);
    CHECK(timed.read<float>(2, 64 * 32) == wanted);
  }
  CHECK(cycles[0] == cycles[1]);
}

TEST_CASE("fragments of wmma are loaded, multiplied and stored in both layouts of each matrix") {
  const FragmentCase cases[] = {
      {"m16n16k16", "f16", "f32", 16, 16, 16, 8, 8, 8},  {"m16n16k16", "f16", "f16", 16, 16, 16, 8, 8, 4},
      {"m32n8k16", "f16", "f32", 32, 8, 16, 8, 8, 8},    {"m32n8k16", "f16", "f16", 32, 8, 16, 8, 8, 4},
      {"m8n32k16", "f16", "f32", 8, 32, 16, 8, 8, 8},    {"m8n32k16", "f16", "f16", 8, 32, 16, 8, 8, 4},
      {"m16n16k16", "bf16", "f32", 16, 16, 16, 4, 4, 8}, {"m32n8k16", "bf16", "f32", 32, 8, 16, 8, 2, 8},
      {"m8n32k16", "bf16", "f32", 8, 32, 16, 2, 8, 8},   {"m16n16k8", "tf32", "f32", 16, 16, 8, 4, 4, 8},
      {"m16n16k16", "s8", "s32", 16, 16, 16, 2, 2, 8},   {"m32n8k16", "u8", "s32", 32, 8, 16, 4, 1, 8},
      {"m8n32k16", "s8", "s32", 8, 32, 16, 1, 4, 8},     {"m8n8k4", "f64", "f64", 8, 8, 4, 1, 1, 2}};
  for (const FragmentCase& c : cases) {
    const int least = c.factor == "u8" ? 0 : -5;
    const Numbers a(c.m, c.k, 1, least, 5), b(c.k, c.n, 2, least, 5), sums(c.m, c.n, 3, -9, 9);
    for (int layouts = 0; layouts < 8; ++layouts) {
      const bool rows_a = layouts & 1, rows_b = layouts & 2, rows_c = layouts & 4;
      const auto name = [](bool rows) { return rows ? "row" : "col"; };
      for (const char* space : {"", "global", "shared"}) {
        INFO(c.shape << " " << c.factor << " " << c.sum << " layouts " << layouts << " " << space);
        Launcher k(fragments_kernel(c, name(rows_a), name(rows_b), name(rows_c), space), "test.ptx", "k");
        const std::vector<uint8_t> of_c = sums.bytes(c.sum, rows_c, 48);
        const auto padded = [](std::vector<uint8_t> bytes) {
          bytes.resize(std::max<size_t>(bytes.size(), 4096));
          return bytes;
        };
        k.buffer(padded(a.bytes(c.factor, rows_a, 48)))
            .buffer(padded(b.bytes(c.factor, rows_b, 48)))
            .buffer(of_c);
        k.run_functional(kWarp);
        Numbers results = sums;
        for (uint32_t row = 0; row < c.m; ++row)
          for (uint32_t column = 0; column < c.n; ++column)
            results.at[row * c.n + column] = product(a, b, sums, row, column);
        CHECK(k.read<uint8_t>(2, of_c.size()) == results.bytes(c.sum, rows_c, 48));
      }
    }
  }
}

TEST_CASE("matrices are stored as they are loaded, and exchanged in registers as in memory") {
  // Lane i writes i * 4 and the words behind it to its row, and loads matrices in several ways.
  const std::string before =
      ".shared .align 16 .b8 sh[1024];\nmov.u32 %r1, sh; mad.lo.u32 %r2, %lane, 16, %r1; mul.lo.u32 %r3, "
      "%lane, "
      "0x00080008; add.u32 %r3, %r3, 0x00010000; add.u32 %r4, %r3, 0x00020002; add.u32 %r5, %r4, 0x00020002; "
      "add.u32 %r6, %r5, 0x00020002; st.shared.v4.b32 [%r2], {%r3,%r4,%r5,%r6};\nbar.warp.sync -1;\n";
  // Half word number h of the memory is h. Matrix m has the half words from 64 * m on.
  const auto straight = [](uint32_t lane) { return (2 * lane) | (2 * lane + 1) << 16; };
  const auto exchanged = [](uint32_t lane) {
    return (8 * (2 * (lane % 4)) + lane / 4) | (8 * (2 * (lane % 4) + 1) + lane / 4) << 16;
  };
  const auto check = [&](const std::string& line, auto of_lane) {
    CAPTURE(line);
    std::vector<uint32_t> wanted;
    for (uint32_t lane = 0; lane < 32; ++lane) wanted.push_back(of_lane(lane));
    CHECK(outputs(storing(before + line)) == wanted);
  };
  const std::string load = "ldmatrix.sync.aligned.m8n8.";
  check(load + "x1.shared.b16 {%out}, [%r2];", straight);
  check(load + "x1.trans.shared.b16 {%out}, [%r2];", exchanged);
  check("ldmatrix.sync.aligned.x1.trans.m8n8.shared.b16 {%out}, [%r2];", exchanged);
  check(load + "x2.shared::cta.b16 {%r7,%out}, [%r2];",
        [&](uint32_t lane) { return straight(lane) + 0x00400040; });
  check(load + "x4.trans.shared.b16 {%r7,%r8,%r9,%out}, [%r2];",
        [&](uint32_t lane) { return exchanged(lane) + 0x00c000c0; });
  check("cvta.shared.u64 %rd1, %rd0; cvt.u64.u32 %rd2, %r2; add.u64 %rd1, %rd1, %rd2; " + load +
            "x1.b16 {%out}, [%rd1];",
        straight);
  check(load + "x1.shared.b16 {%r7}, [%r2]; movmatrix.sync.aligned.m8n8.trans.b16 %out, %r7;", exchanged);
  check(load +
            "x4.shared.b16 {%r7,%r8,%r9,%r10}, [%r2]; stmatrix.sync.aligned.m8n8.x4.trans.shared.b16 "
            "[%r2+512], "
            "{%r7,%r8,%r9,%r10};\nbar.warp.sync -1; ld.shared.b32 %out, [%r2+516];",
        [](uint32_t lane) {
          // Word 1 of row r of matrix m: columns 2 and 3, which were rows 2 and 3.
          const uint32_t m = lane / 8, row = lane % 8;
          return (64 * m + 16 + row) | (64 * m + 24 + row) << 16;
        });
}

TEST_CASE("products of fp8, of doubles with 16 rows, and of integers give what plain arithmetic gives") {
  // All elements of a matrix are equal, so that each sum is depth * a * b + c.
  const auto check = [](const std::string& line, uint32_t wanted) {
    CAPTURE(line);
    CHECK(outputs(storing(line)) == std::vector<uint32_t>(32, wanted));
  };
  const std::string ones = "mov.u32 %r1, 0x38383838; mov.u32 %r2, 0x40404040; mov.u32 %r3, 0x3f000000;\n";
  check(ones +
            "mma.sync.aligned.m16n8k32.row.col.f32.e4m3.e4m3.f32 {%r4,%r5,%r6,%out}, {%r1,%r1,%r1,%r1}, "
            "{%r2,%r2}, "
            "{%r3,%r3,%r3,%r3};",
        std::bit_cast<uint32_t>(64.5f));
  check(ones + "mma.sync.aligned.m16n8k16.row.col.f16.e4m3.e5m2.f16 {%r4,%out}, {%r1,%r1}, {%r2}, {%r3,%r3};",
        0x5000'5000u | 0x0038'0000u);
  check(
      "mov.f64 %rd1, 0d3ff0000000000000; mov.f64 %rd2, 0d4000000000000000;\n"
      "mma.sync.aligned.m16n8k8.row.col.f64.f64.f64.f64 {%rd3,%rd4,%rd5,%rd6}, {%rd1,%rd1,%rd1,%rd1}, "
      "{%rd2,%rd2}, "
      "{%rd1,%rd1,%rd1,%rd1}; cvt.rni.u32.f64 %out, %rd6;",
      17);
  check(
      "mov.u32 %r1, 0x7f7f7f7f; mov.u32 %r2, 0x7fffffff;\n"
      "mma.sync.aligned.m16n8k32.row.col.satfinite.s32.s8.s8.s32 {%r4,%r5,%r6,%out}, {%r1,%r1,%r1,%r1}, "
      "{%r1,%r1}, "
      "{%r2,%r2,%r2,%r2};",
      0x7fff'ffff);
  check(
      "mov.u32 %r1, 0x7f7f7f7f; mov.u32 %r2, 0x7fffffff;\n"
      "mma.sync.aligned.m8n8k16.row.col.s32.s8.s8.s32 {%r4,%out}, {%r1}, {%r1}, {%r2,%r2};",
      0x8000'0000u + 16 * 127 * 127 - 1);
}

TEST_CASE("a product of doubles may say that it rounds to nearest") {
  const std::string before = "mov.f64 %rd1, 0d3ff0000000000000; mov.f64 %rd2, 0d4000000000000000;\n";
  const std::string after = " {%rd3,%rd4}, {%rd1}, {%rd2}, {%rd1,%rd1}; cvt.rni.u32.f64 %out, %rd4;";
  for (const char* types :
       {"m8n8k4.f64.f64.f64.f64", "m8n8k4.f64.f64.f64.f64.rn", "m8n8k4.rn.f64.f64.f64.f64"})
    CHECK(outputs(storing(before + "wmma.mma.sync.aligned.row.col." + types + after)) ==
          std::vector<uint32_t>(32, 9));
}

TEST_CASE("the results of a wmma may be registers that later steps of it read") {
  // The sums are written to the registers of A, and those of C in another order.
  const std::string line =
      "mov.u32 %r1, 0x3c003c00; mov.u32 %r2, 0x3f800000;\n"
      "mov.u32 %r10, %r1; mov.u32 %r11, %r1; mov.u32 %r12, %r1; mov.u32 %r13, %r1; mov.u32 %r14, %r1; "
      "mov.u32 %r15, %r1; "
      "mov.u32 %r16, %r1; mov.u32 %r17, %r1;\n"
      "wmma.mma.sync.aligned.row.col.m16n16k16.f32.f32 {%r10,%r11,%r12,%r13,%r14,%r15,%r16,%out}, "
      "{%r10,%r11,%r12,%r13,%r14,%r15,%r16,%r17}, {%r10,%r11,%r12,%r13,%r14,%r15,%r16,%r17}, "
      "{%r2,%r2,%r2,%r2,%r2,%r2,%r2,%r2};";
  CHECK(outputs(storing(line)) == std::vector<uint32_t>(32, std::bit_cast<uint32_t>(17.0f)));
}

TEST_CASE("a product waits for the sums before it for the latency, and for its pipe for the interval") {
  // Returns the cycles of a kernel with `count` products that take turns on so many chains of sums.
  const auto cycles = [](uint32_t count, uint32_t chains) {
    std::string body = "mov.u32 %r1, 0x3c003c00;\n";
    for (uint32_t c = 0; c < chains; ++c)
      for (uint32_t i = 0; i < 4; ++i) body += fmt::format("mov.u32 %r{}, %lane; ", 2 + 4 * c + i);
    for (uint32_t n = 0; n < count; ++n) {
      const uint32_t c = 2 + 4 * (n % chains);
      const std::string sums = fmt::format("{{%r{},%r{},%r{},%r{}}}", c, c + 1, c + 2, c + 3);
      body += fmt::format(
          "mma.sync.aligned.m16n8k16.row.col.f32.f16.f16.f32 {0}, {{%r1,%r1,%r1,%r1}}, {{%r1,%r1}}, {0};\n",
          sums);
    }
    for (uint32_t c = 0; c < chains; ++c) body += fmt::format("add.u32 %out, %out, %r{};\n", 5 + 4 * c);
    Launcher k(storing(body), "test.ptx", "k");
    k.buffer(std::vector<uint32_t>(32));
    pipeline::GpuParams params;
    params.cores = 1;
    params.core.units.tensor = {24, 6};
    return k.run_timing(kWarp, params);
  };

  CHECK(cycles(88, 1) - cycles(56, 1) == 32 * 24);
  CHECK(cycles(88, 2) - cycles(56, 2) == 32 * 12);
  CHECK(cycles(88, 4) - cycles(56, 4) == 32 * 6);
}

TEST_CASE("products that are not there are refused with the shapes that are") {
  CHECK(contains(answer_to("mma.sync.aligned.m16n8k64.row.col.f32.f16.f16.f32 {%r1}, {%r2}, {%r3}, {%r4};"),
                 "with these types there are the shapes m16n8k16, m16n8k8, with .row.col"));
  CHECK(contains(answer_to("mma.sync.aligned.m16n8k16.row.row.f32.f16.f16.f32 {%r1}, {%r2}, {%r3}, {%r4};"),
                 "not supported: 'mma.sync.aligned.m16n8k16.row.row.f32.f16.f16.f32'"));
  CHECK(contains(answer_to("mma.sync.aligned.m16n8k32.row.col.f32.e3m2.e3m2.f32 {%r1}, {%r2}, {%r3}, {%r4};"),
                 "there are the types"));
  CHECK(contains(
      answer_to("mma.sync.aligned.m16n8k8.row.col.f32.f16.f16.f32 {%r1,%r2}, {%r1,%r2}, {%r3}, {%r4};"),
      "operand 1 of 'mma.sync.aligned.m16n8k8.row.col.f32.f16.f16.f32' has 4 registers, not 2"));
  CHECK(contains(answer_to("ldmatrix.sync.aligned.m16n16.x1.trans.shared.b8 {%r1}, [%r2];"),
                 "there are .m8n8 with .x1, .x2 and .x4"));
  CHECK(
      contains(answer_to("wmma.load.a.sync.aligned.row.m16n16k32.f16 {%r1}, [%rd2];"), "wmma has m16n16k16"));
  CHECK(contains(
      answer_to("wmma.mma.sync.aligned.row.col.m16n16k16.f32.bf16.f16.f32 {%r1}, {%r1}, {%r1}, {%r1};"),
      "wmma has m16n16k16"));
  CHECK(contains(answer_to("wgmma.fence.sync.aligned;"), "belongs to asynchronous ops of tensor cores"));
}
