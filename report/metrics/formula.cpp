// Evaluates formulas in a recursive-descent reader that computes while it reads.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/formula.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fmt/format.h>
#include <numeric>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"
#include "report/metrics/compare_samples.h"

namespace glint::report {
namespace {

using Maybe = std::optional<double>;

template <class Function>
Maybe both(Maybe a, Maybe b, Function function) {
  return a && b ? Maybe(function(*a, *b)) : std::nullopt;
}

// These beginnings of paths stand for the paths of all instances.
constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
    {"core.", "gpu.core[*]."},
    {"rt.", "gpu.rt_unit[*].rt."},
    {"l1.", "gpu.memory.core[*].l1."},
    {"l2.", "gpu.memory.partition[*].l2*."},
    {"dram.", "gpu.memory.partition[*].dram."}};

// Maps paths of the timing machine to those of the functional machine, which are looked up when the former do
// not exist. Choice: a metric means the same whichever machine counted it. A beginning that ends in "::"
// keeps the name of the part behind it.
constexpr std::pair<std::string_view, std::string_view> kFunctional[] = {
    {"gpu.core[*].lane_instructions", "gpu.lanes::*"},
    {"gpu.core[*].instructions", "gpu.instructions::*"},
    {"gpu.core[*].instructions_by_class::", "gpu.instructions::"},
    {"gpu.rt_unit[*].rt.rays", "gpu.rays"},
    {"gpu.rt_unit[*].rt.nodes", "gpu.nodes"},
    {"gpu.rt_unit[*].rt.box_tests", "gpu.box_tests"},
    {"gpu.rt_unit[*].rt.triangle_tests", "gpu.triangle_tests"}};

std::vector<double> functional_values(const RunRecord& run, std::string_view path) {
  for (const auto& [timing, functional] : kFunctional) {
    if (path == timing) return run.values(std::string(functional));
    if (timing.ends_with("::") && path.starts_with(timing))
      return run.values(std::string(functional) + std::string(path.substr(timing.size())));
  }
  return {};
}

std::string whole_path(const std::string& path) {
  for (const auto& [unit, prefix] : kUnits)
    if (path.rfind(unit, 0) == 0) return std::string(prefix) + path.substr(unit.size());
  return path;
}

// The grammar is: sum := product { (+|-) product };  product := atom { (*|/) atom };  atom := number |
// NAME(text) | (sum)
class Reader {
 public:
  Reader(std::string_view text, const RunRecord* run) : text_(text), run_(run) {}

  Maybe read_all() {
    const Maybe value = read_sum();
    if (!rest().empty()) fail("an operator or the end");
    return value;
  }
  std::vector<std::string> paths;  // the paths that were named so far

 private:
  std::string_view rest() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return text_.substr(at_);
  }
  bool take(char c) {
    if (rest().empty() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  [[noreturn]] void fail(const std::string& expected) const {
    throw UserError(
        {}, fmt::format("'{}' is not a formula: expected {} at '{}'", text_, expected, text_.substr(at_)));
  }

  Maybe read_sum() {
    Maybe value = read_product();
    for (;;) {
      if (take('+'))
        value = both(value, read_product(), [](double a, double b) { return a + b; });
      else if (take('-'))
        value = both(value, read_product(), [](double a, double b) { return a - b; });
      else
        return value;
    }
  }

  Maybe read_product() {
    Maybe value = read_atom();
    for (;;) {
      if (take('*')) {
        value = both(value, read_atom(), [](double a, double b) { return a * b; });
      } else if (take('/')) {
        const Maybe below = read_atom();
        value = below && *below == 0 ? std::nullopt
                                     : both(value, below, [](double a, double b) { return a / b; });
      } else {
        return value;
      }
    }
  }

  Maybe read_atom() {
    if (take('(')) {
      const Maybe value = read_sum();
      if (!take(')')) fail("')'");
      return value;
    }
    const std::string_view here = rest();
    double number = 0;
    const auto [end, error] = std::from_chars(here.data(), here.data() + here.size(), number);
    if (error == std::errc{}) {
      at_ += size_t(end - here.data());
      return number;
    }
    const size_t open = here.find('('), close = here.find(')');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open)
      fail("a number or sum(PATH)");
    at_ += close + 1;
    return look_up(std::string(here.substr(0, open)), std::string(here.substr(open + 1, close - open - 1)));
  }

  Maybe look_up(const std::string& function, const std::string& written) {
    const bool is_fact = function == "run" || function == "config";
    const std::string name = is_fact ? written : whole_path(written);
    if (!is_fact && function != "sum" && function != "max" && function != "mean")
      throw UserError({}, fmt::format("'{}' is not a function of a formula", function),
                      "the functions are sum, max, mean, run and config");
    if (!is_fact) paths.push_back(name);
    if (!run_) return std::nullopt;
    if (is_fact) return function == "run" ? run_->fact(name) : run_->config(name);
    std::vector<double> values = run_->values(name);
    if (values.empty()) values = functional_values(*run_, name);
    if (values.empty()) return std::nullopt;
    if (function == "max") return *std::max_element(values.begin(), values.end());
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    return function == "sum" ? sum : sum / double(values.size());
  }

  std::string_view text_;
  const RunRecord* run_;  // null: the reader only reads and computes nothing
  size_t at_ = 0;
};

}  // namespace

std::optional<double> evaluate(const std::string& formula, const RunRecord& run) {
  return Reader(formula, &run).read_all();
}

std::string why_absent(const RunRecord& run) {
  if (is_sampled(run)) return "this run is a sample; its estimates are the statistics gpu.sample.*";
  return run.text("mode") == "functional"
             ? "only the timing machine counts it, or there is nothing to divide by"
             : "there is nothing to divide by, or this run did not count it";
}

std::vector<std::string> paths_in(const std::string& formula) {
  Reader reader(formula, nullptr);
  reader.read_all();
  return reader.paths;
}

}  // namespace glint::report
