// Compares GLSL's built-ins, 138 expressions on 2,048 inputs, with the recordings of a real driver, if they
// are present.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <set>
#include <zstd.h>

#include "exec/image.h"
#include "frontend/compile.h"
#include "isa/verify.h"
#include "memsys/address_space.h"
#include "pipeline/functional_machine.h"
#include "tests/shaders/builtin_reference.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

namespace fs = std::filesystem;
constexpr uint32_t kLanes = 2048;
using Words = std::vector<uint32_t>;

fs::path golden_folder() {
  const char* named = std::getenv("GLINT_GLSL_GOLDEN_DIR");
  return named ? fs::path(named) : fs::path(GLINT_SOURCE_DIR) / ".." / "shared" / "data" / "glsl-golden";
}

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  REQUIRE(in.good());
  return {std::istreambuf_iterator<char>(in), {}};
}

// Returns the words of the file, or of its compressed form with the ending .zst.
Words words_of(const fs::path& path) {
  std::string data;
  if (fs::exists(path)) {
    data = text_of(path);
  } else {
    const std::string packed = text_of(path.string() + ".zst");
    data.resize(ZSTD_getFrameContentSize(packed.data(), packed.size()));
    REQUIRE(ZSTD_decompress(data.data(), data.size(), packed.data(), packed.size()) == data.size());
  }
  Words words(data.size() / 4);
  std::memcpy(words.data(), data.data(), words.size() * 4);
  return words;
}

struct Recorded {
  struct Expression {
    std::string text;
    bool is_float = false;
  };
  std::vector<Expression> expressions;
  Words in, out;

  explicit Recorded(const fs::path& folder)
      : in(words_of(folder / "inputs.bin")), out(words_of(folder / "outputs.bin")) {
    std::ifstream list(folder / "ops.txt");
    for (std::string type, text; list >> type && std::getline(list >> std::ws, text);)
      expressions.push_back({text, type == "f32"});
    REQUIRE(in.size() == 3 * kLanes);
    REQUIRE(out.size() == expressions.size() * kLanes);
  }
  Inputs inputs(uint32_t lane) const {
    const auto f = [&](uint32_t i) { return std::bit_cast<float>(in[i * kLanes + lane]); };
    return {f(0), f(1), f(2), in[lane], in[kLanes + lane], in[2 * kLanes + lane]};
  }
};

// Runs the shader once for each expression. In set 0, binding 0 has the inputs and binding 1 the outputs. The
// push constants are {expression, lanes}.
Words run_all(const fs::path& shader, const Recorded& recorded) {
  Diagnostics diagnostics;
  const isa::Program program = frontend::compile_file(shader.string(), {}, {}, diagnostics);
  isa::verify(program, diagnostics);
  diagnostics.throw_if_errors();
  const exec::Image image = exec::link({program});
  mem::AddressSpace memory;
  exec::World world;
  world.image = &image;
  world.memory = &memory;
  world.constant_bank.resize(isa::kConstantBankBytes);
  world.raygen = 0;
  world.launch_size = {kLanes, 1, 1};
  world.local_bytes = program.local_bytes;
  const uint64_t in_bytes = recorded.in.size() * 4, out_bytes = recorded.out.size() * 4;
  const uint64_t descriptors[4] = {memory.allocate("in", in_bytes), in_bytes,
                                   memory.allocate("out", out_bytes), out_bytes};
  memory.write(descriptors[0], recorded.in.data(), in_bytes);
  std::memcpy(world.constant_bank.data(), descriptors, sizeof(descriptors));
  for (uint32_t op = 0; op < recorded.expressions.size(); ++op) {
    const uint32_t push[2] = {op, kLanes};
    std::memcpy(world.constant_bank.data() + isa::kPushConstantOffset, push, sizeof(push));
    pipeline::run_functional(world, 100'000, {});
  }
  const auto words = memory.view<uint32_t>(descriptors[2], recorded.out.size());
  return {words.begin(), words.end()};
}

bool is_subnormal(float x) {
  return std::fpclassify(x) == FP_SUBNORMAL;
}

// Lists where integer results may differ from the driver's, and why. `kept` gives the required results, or is
// null.
struct Exception {
  std::string_view expression, reason;
  bool (*applies)(const Inputs&);
  uint32_t (*kept)(const Inputs&) = nullptr;
};
bool any_subnormal(const Inputs& x) {
  return is_subnormal(x.a) || is_subnormal(x.b) || is_subnormal(x.c);
}
constexpr std::string_view kFlushed =
    "the driver flushes subnormals to 0, Glint keeps them; Vulkan allows both";
constexpr std::string_view kOutOfRange = "out of the integer's range, or NaN: undefined (GLSL 5.4.1)";
constexpr std::string_view kPackedNan = "packing of NaN is undefined (GLSL 8.4: clamp of NaN)";
constexpr Exception kExceptions[] = {
    {"uint(a)", kOutOfRange, [](const Inputs& x) { return !(x.a > -1.0f && x.a < 0x1p32f); }},
    {"uint(int(a))", kOutOfRange, [](const Inputs& x) { return !(x.a >= -0x1p31f && x.a < 0x1p31f); }},
    {"packHalf2x16(vec2(a,b))", "the bits of a NaN are not defined",
     [](const Inputs& x) { return std::isnan(x.a) || std::isnan(x.b); }},
    {"packSnorm2x16(vec2(a,b))", kPackedNan,
     [](const Inputs& x) { return std::isnan(x.a) || std::isnan(x.b); }},
    {"packUnorm2x16(vec2(a,b))", kPackedNan,
     [](const Inputs& x) { return std::isnan(x.a) || std::isnan(x.b); }},
    {"packSnorm4x8(vec4(a,b,c,a))", kPackedNan,
     [](const Inputs& x) { return std::isnan(x.a) || std::isnan(x.b) || std::isnan(x.c); }},
    {"packUnorm4x8(vec4(a,b,c,a))", kPackedNan,
     [](const Inputs& x) { return std::isnan(x.a) || std::isnan(x.b) || std::isnan(x.c); }},
    {"frexp_e(a)", kFlushed, any_subnormal,
     [](const Inputs& x) {
       int e;
       std::frexp(x.a, &e);
       return uint32_t(e);
     }},
    {"uint(a<b)", kFlushed, any_subnormal, [](const Inputs& x) { return uint32_t(x.a < x.b); }},
    {"uint(a<=b)", kFlushed, any_subnormal, [](const Inputs& x) { return uint32_t(x.a <= x.b); }},
    {"uint(a>b)", kFlushed, any_subnormal, [](const Inputs& x) { return uint32_t(x.a > x.b); }},
    {"uint(a>=b)", kFlushed, any_subnormal, [](const Inputs& x) { return uint32_t(x.a >= x.b); }},
    {"uint(a==b)", kFlushed, any_subnormal, [](const Inputs& x) { return uint32_t(x.a == x.b); }},
    {"uint(a!=b)", kFlushed, any_subnormal, [](const Inputs& x) { return uint32_t(x.a != x.b); }},
    {"uint(a!=0.0?bool(ua):false)", kFlushed, any_subnormal,
     [](const Inputs& x) { return uint32_t(x.a != 0); }},
    {"uint(any(lessThan(vec3(a,b,c),vec3(b,c,a))))", kFlushed, any_subnormal,
     [](const Inputs& x) { return uint32_t(x.a < x.b || x.b < x.c || x.c < x.a); }},
    {"uint(all(greaterThanEqual(vec3(a,b,c),vec3(-1.0))))", kFlushed, any_subnormal,
     [](const Inputs& x) { return uint32_t(x.a >= -1 && x.b >= -1 && x.c >= -1); }},
};

// Summarises the lanes of one expression.
struct Result {
  uint32_t equal = 0, within = 0, excepted = 0, open = 0, wrong = 0;
  double p99_ours = 0, p99_driver = 0, worst_ours = 0, worst_driver = 0;
  bool too_far = false;  // at the 99th percentile
  std::string first_wrong;
  std::set<std::string_view> reasons;

  bool holds() const { return wrong == 0 && !too_far; }
  void note_wrong(const Inputs& x, uint32_t ours, uint32_t driver, double expected, double allowed) {
    if (wrong++ == 0)
      first_wrong = fmt::format(
          "a {:08x} {:g} b {:08x} {:g} c {:08x} {:g}: {:08x} {:g}, driver {:08x} {:g}, exact {:.9g} within "
          "{:g}",
          x.ua, x.a, x.ub, x.b, x.uc, x.c, ours, std::bit_cast<float>(ours), driver,
          std::bit_cast<float>(driver), expected, allowed);
  }
};

Result compare_integers(std::string_view expression, const Recorded& recorded, const uint32_t* ours,
                        const uint32_t* driver) {
  const auto exception = std::find_if(std::begin(kExceptions), std::end(kExceptions),
                                      [&](const Exception& e) { return e.expression == expression; });
  Result result;
  for (uint32_t lane = 0; lane < kLanes; ++lane) {
    const Inputs x = recorded.inputs(lane);
    if (ours[lane] == driver[lane]) {
      ++result.equal;
    } else if (exception != std::end(kExceptions) && exception->applies(x) &&
               (!exception->kept || exception->kept(x) == ours[lane])) {
      ++result.excepted;
      result.reasons.insert(exception->reason);
    } else {
      result.note_wrong(x, ours[lane], driver[lane], driver[lane], 0);
    }
  }
  return result;
}

bool is_moderate(float x) {
  return std::abs(x) >= 1e-3f && std::abs(x) <= 1e3f;
}

// Returns the ulps of the moderate inputs in ascending order; `n` of them count.
std::vector<double> moderate_ulps(const BuiltinReference& reference, const Recorded& recorded,
                                  const uint32_t* words) {
  std::vector<double> ulps;
  for (uint32_t lane = 0; lane < kLanes; ++lane) {
    const Inputs x = recorded.inputs(lane);
    if (!is_moderate(x.a) || !is_moderate(x.b) || !is_moderate(x.c) ||
        (reference.is_defined && !reference.is_defined(x)))
      continue;
    const double v = reference.value(x);
    if (!(std::abs(v) >= kSmallestNormal && std::abs(v) <= kLargest)) continue;
    const double error = std::abs(double(std::bit_cast<float>(words[lane])) - v) / ulp(v);
    ulps.push_back(std::isnan(error) ? kUnbounded : error);
  }
  std::sort(ulps.begin(), ulps.end());
  return ulps;
}
double percentile_99(const std::vector<double>& ulps) {
  return ulps.empty() ? 0 : ulps[size_t(0.99 * double(ulps.size() - 1))];
}

// The 99th percentile is held to the driver's: it may be this factor of it, because one rounding more or less
// moves it by some percent, or this small.
constexpr double kMostOfDriver = 1.1, kSmallUlps = 1.5;
// Where results are smaller, products that the driver flushes to 0 may show in them.
constexpr float kSmallestSame = 0x1p-100f;
// Where Vulkan bounds no error, the error is still this small, except for the lanes that are counted as open.
constexpr double kOpenUlps = 4;

bool is_near(float got, double v, double allowed) {
  if (std::isnan(v)) return std::isnan(got);
  if (std::abs(v) >= kLargest + ulp(kLargest) / 2)  // overflows, within the error of the largest floats
    return std::signbit(got) == std::signbit(v) &&
           double(std::abs(got)) >= std::min(kLargest, std::abs(v)) - allowed;
  return std::abs(double(got) - v) <= allowed;
}

Result compare_floats(const BuiltinReference& reference, const Recorded& recorded, const uint32_t* ours,
                      const uint32_t* driver) {
  Result result;
  const std::vector<double> ulps = moderate_ulps(reference, recorded, ours),
                            driver_ulps = moderate_ulps(reference, recorded, driver);
  result.p99_ours = percentile_99(ulps);
  result.p99_driver = percentile_99(driver_ulps);
  double p99_allowed = std::max(kMostOfDriver * result.p99_driver, kSmallUlps);
  if (reference.in_order) {
    Words formula;
    for (uint32_t lane = 0; lane < kLanes; ++lane)
      formula.push_back(std::bit_cast<uint32_t>(reference.in_order(recorded.inputs(lane))));
    p99_allowed = std::max(p99_allowed, percentile_99(moderate_ulps(reference, recorded, formula.data())));
  }
  result.too_far = result.p99_ours > p99_allowed;
  const double driver_worst = driver_ulps.empty() ? 0 : driver_ulps.back();
  result.worst_driver = driver_worst, result.worst_ours = ulps.empty() ? 0 : ulps.back();
  for (uint32_t lane = 0; lane < kLanes; ++lane) {
    const Inputs x = recorded.inputs(lane);
    const double v = reference.value(x);
    const double allowed = std::max(reference.bound(x).e,
                                    std::isinf(v) ? 0 : driver_worst * ulp(std::min(std::abs(v), kLargest)));
    const float got = std::bit_cast<float>(ours[lane]);
    if (ours[lane] == driver[lane]) {
      ++result.equal;
    } else if (reference.is_same_form && !any_subnormal(x) && std::abs(got) >= kSmallestSame) {
      result.note_wrong(x, ours[lane], driver[lane], v, 0);
    } else if (reference.is_defined && !reference.is_defined(x)) {
      ++result.excepted;
      result.reasons.insert("outside of the function's domain, or NaN where one operand is chosen");
    } else if (is_near(got, v, std::isinf(allowed) ? kOpenUlps * ulp(v) : allowed)) {
      ++result.within;
    } else if (std::isinf(allowed)) {
      ++result.open;
    } else {
      result.note_wrong(x, ours[lane], driver[lane], v, allowed);
    }
  }
  return result;
}

}  // namespace

TEST_CASE("built-in functions of GLSL give a driver's integers, and floats within Vulkan's precision") {
  const fs::path folder = golden_folder();
  if (!fs::exists(folder / "ops.comp")) {
    WARN("SKIPPED: no recordings of built-ins in " << folder.string()
                                                   << "; name their folder in GLINT_GLSL_GOLDEN_DIR");
    return;
  }
  const Recorded recorded(folder);
  const Words ours = run_all(folder / "ops.comp", recorded);
  fmt::print("{:61} {:>5} {:>6} {:>8} {:>5} {:>5} {:>11} {:>11} {:>11} {:>11}\n", "expression", "equal",
             "within", "excepted", "open", "wrong", "p99 ulp", "driver's", "worst", "driver's");
  size_t hold = 0;
  std::set<std::string_view> reasons;
  for (size_t op = 0; op < recorded.expressions.size(); ++op) {
    const auto& [text, is_float] = recorded.expressions[op];
    const uint32_t *mine = &ours[op * kLanes], *theirs = &recorded.out[op * kLanes];
    const BuiltinReference* reference = find_reference(text);
    INFO(text);
    REQUIRE((reference != nullptr) == is_float);
    const Result r = is_float ? compare_floats(*reference, recorded, mine, theirs)
                              : compare_integers(text, recorded, mine, theirs);
    hold += r.holds();
    reasons.insert(r.reasons.begin(), r.reasons.end());
    fmt::print("{:61} {:5} {:6} {:8} {:5} {:5} {:>11} {:>11} {:>11} {:>11} {}\n", text, r.equal, r.within,
               r.excepted, r.open, r.wrong, is_float ? fmt::format("{:.3g}", r.p99_ours) : "",
               is_float ? fmt::format("{:.3g}", r.p99_driver) : "",
               is_float ? fmt::format("{:.4g}", r.worst_ours) : "",
               is_float ? fmt::format("{:.4g}", r.worst_driver) : "",
               r.holds()   ? "holds"
               : r.too_far ? "FAILS at the 99th percentile"
                           : "FAILS: " + r.first_wrong);
    CHECK(r.holds());
  }
  fmt::print("excepted: {}\nopen: lanes for which Vulkan bounds no error\n{} of {} hold\n",
             fmt::join(reasons, "; "), hold, recorded.expressions.size());
}

}  // namespace glint::test
