// Compiles every PTX form that a GPU has recorded from its text, runs it on all SIMD paths and expects the
// same bits.
// SPDX-License-Identifier: Apache-2.0
//
// GLINT_PTX_GOLDEN_DIR names the folder of the recordings. GLINT_GOLDEN_FORMS selects forms by a part of
// their names; each selected form then prints a line.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

#include "tests/isa/golden/recording.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::golden;

namespace {

// Lists the forms that Glint does not have, and why.
struct Missing {
  const char* op;
  const char* why;
};
constexpr std::array<Missing, 0> kMissing{};

bool is_missing(const std::string& op) {
  return std::any_of(kMissing.begin(), kMissing.end(), [&](const Missing& m) { return op == m.op; });
}

// Returns true for approximations. They may be off by 2 ulp or, near zeros of the function, by an absolute
// error: the hardware's own largest error against the exact function, measured over all mantissas.
bool is_approximate(const std::string& op) {
  return op.find(".approx") != std::string::npos || op.find("div.full") != std::string::npos;
}
double absolute_bound(const std::string& op) {
  if (op.starts_with("sin.")) return 3.5e-7;
  if (op.starts_with("cos.")) return 4.0e-7;
  if (op.starts_with("lg2.")) return 2.2e-7;
  if (op.starts_with("tanh.") && op.ends_with("f32")) return 8e-6;
  return 0;
}

struct FloatFormat {
  int bits, mantissa;
};
FloatFormat format_of(const std::string& type) {
  if (type == "f64") return {64, 52};
  if (type.starts_with("f16")) return {16, 10};
  if (type.starts_with("bf16")) return {16, 7};
  return {32, 23};
}

double as_double(uint64_t bits, FloatFormat f) {
  const int exponents = f.bits - 1 - f.mantissa, bias = (1 << (exponents - 1)) - 1;
  const uint64_t exponent = bits >> f.mantissa & ((1ull << exponents) - 1),
                 fraction = bits & ((1ull << f.mantissa) - 1);
  const double value =
      exponent ? std::ldexp(double(fraction | 1ull << f.mantissa), int(exponent) - bias - f.mantissa)
               : std::ldexp(double(fraction), 1 - bias - f.mantissa);
  return bits >> (f.bits - 1) & 1 ? -value : value;
}

// Returns the distance in units of the last place. It is huge between NaN and any other value.
double ulps(uint64_t a, uint64_t b, FloatFormat f) {
  const uint64_t sign = 1ull << (f.bits - 1), infinity = ((1ull << (f.bits - 1 - f.mantissa)) - 1)
                                                         << f.mantissa;
  if ((a & ~sign) > infinity || (b & ~sign) > infinity) return a == b ? 0 : 1e30;
  const auto key = [&](uint64_t x) { return x & sign ? -double(x & ~sign) : double(x); };
  return std::abs(key(a) - key(b));
}

// Computes the largest difference of one value; x2 pairs are compared half by half. Returns true when the
// difference is allowed for the form.
bool is_near(const std::string& op, const std::string& type, uint64_t got, uint64_t expected, double& worst) {
  const FloatFormat f = format_of(type);
  bool near = true;
  const bool pair = type.ends_with("x2");
  for (int half = 0; half < (pair ? 2 : 1); ++half) {
    const uint64_t mask = f.bits == 64 ? ~0ull : (1ull << f.bits) - 1;
    const uint64_t a = got >> (16 * half) & mask, b = expected >> (16 * half) & mask;
    const double off = ulps(a, b, f);
    worst = std::max(worst, off);
    near &= off <= 2 || (off < 1e29 && std::abs(as_double(a, f) - as_double(b, f)) <= absolute_bound(op));
  }
  return near;
}

enum class Verdict { Equal, Near, Differs, Missing };

struct Comparison {
  Verdict verdict = Verdict::Equal;
  std::string line;  // report on the form
};

std::string lane_text(const Recording& r, const Form& form, uint32_t lane) {
  std::string text = "lane " + std::to_string(lane) + ": (";
  char number[32];
  for (size_t i = 0; i < form.inputs.size(); ++i) {
    std::snprintf(number, sizeof number, "%s%llx", i ? ", " : "",
                  static_cast<unsigned long long>(r.input(form, i, lane)));
    text += number;
  }
  return text + ")";
}

Comparison compare(const Recording& r, const Form& form) {
  const Outcome outcome = run(r, form);
  if (!outcome.refused.empty()) return {Verdict::Missing, outcome.refused};
  Comparison out;
  double worst = 0;
  uint32_t different = 0, wrong = 0;
  for (size_t p = 0; p < outcome.paths.size(); ++p)
    for (size_t i = 0; i < form.outputs.size(); ++i)
      for (uint32_t lane = 0; lane < r.lanes; ++lane) {
        const uint64_t got = outcome.outputs[p][i][lane], expected = r.output(form, i, lane);
        if (got == expected) continue;
        ++different;
        const bool near =
            is_approximate(form.op) && is_near(form.op, form.outputs[i].type, got, expected, worst);
        if (near || wrong++) continue;
        char text[160];
        std::snprintf(text, sizeof text, " D%zu: recorded %llx, got %llx (%s)", i,
                      static_cast<unsigned long long>(expected), static_cast<unsigned long long>(got),
                      std::string(isa::name_of(outcome.paths[p])).c_str());
        out.line = lane_text(r, form, lane) + text;
      }
  out.verdict = wrong ? Verdict::Differs : different ? Verdict::Near : Verdict::Equal;
  const double values = double(r.lanes) * double(form.outputs.size() * outcome.paths.size());
  char text[96];
  if (different && is_approximate(form.op))
    std::snprintf(text, sizeof text, "  %.2f %% equal, at most %.6g ulp", 100 * (1 - different / values),
                  worst);
  else
    std::snprintf(text, sizeof text, "  %u of %.0f differ", different, values);
  out.line += text;
  return out;
}

void compare_all(const Recording& r, const std::string& what) {
  static constexpr const char* kWords[] = {"equal", "near", "DIFFERS", "no support"};
  const char* const filter = std::getenv("GLINT_GOLDEN_FORMS");
  uint32_t count[4] = {};
  std::string unexpected;
  for (const Form& form : r.forms) {
    if (filter && form.op.find(filter) == std::string::npos) continue;
    const Comparison c = compare(r, form);
    ++count[size_t(c.verdict)];
    if (filter || c.verdict != Verdict::Equal)
      std::printf("%-10s %-36s %s\n", kWords[size_t(c.verdict)], form.op.c_str(), c.line.c_str());
    if (c.verdict == Verdict::Differs || (c.verdict == Verdict::Missing) != is_missing(form.op))
      unexpected += "  " + form.op;
  }
  std::printf("%s: %u forms equal, %u within ulp, %u differ, %u not supported\n", what.c_str(), count[0],
              count[1], count[2], count[3]);
  INFO("forms that should not differ or be missing:" << unexpected);
  CHECK(unexpected.empty());
}

}  // namespace

TEST_CASE("every form of the recordings gives the bits of a GPU on every path, approximations within 2 ulp") {
  const char* const named = std::getenv("GLINT_PTX_GOLDEN_DIR");
  const std::filesystem::path folder =
      named ? std::filesystem::path(named)
            : std::filesystem::path(GLINT_SOURCE_DIR) / "../shared/data/ptx-golden";
  if (!std::filesystem::exists(folder / "manifest.json")) {
    WARN("SKIPPED: no recordings of a GPU in " << folder.string());
    return;
  }
  compare_all(load_folder(folder), "recordings");
}

TEST_CASE("every form of the extract gives the bits of a GPU on every path, approximations within 2 ulp") {
  compare_all(load_extract(std::filesystem::path(GLINT_SOURCE_DIR) / "tests/isa/golden/data"), "extract");
}

// These rows are missing in the recordings above. tools/record_vectors.py recorded them on an H200: the rest
// of the cross product.
TEST_CASE("every form of the further extract gives the bits of a GPU on every path") {
  compare_all(load_extract(std::filesystem::path(GLINT_SOURCE_DIR) / "tests/isa/golden/further"),
              "further extract");
}
