// Implements the format `json` of statistics: a JSON tree in which groups are objects and a statistic is
// {"value", "unit", "doc"}.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/check.h"
#include "report/files/stat_writer.h"

namespace glint::report {
namespace {

// Writes the tree while it is visited. nlohmann writes what needs rules: numbers with a fraction, and strings
// with characters that must be escaped.
class JsonVisitor final : public stats::Visitor {
 public:
  JsonVisitor() { open('{'); }
  // Returns the whole text, after the visit.
  std::string text() && {
    close('}');
    out_ += '\n';
    return std::move(out_);
  }

  void enter(const stats::Group& group) override {
    key(group.name());
    open('{');
  }
  void leave(const stats::Group&) override { close('}'); }
  void visit(const stats::Counter& stat) override {
    begin(stat);
    number(stat.value());
    end(stat);
  }
  void visit(const stats::Ratio& stat) override { fraction(stat, stat.value()); }
  void visit(const stats::Value& stat) override { fraction(stat, stat.value()); }
  void visit(const stats::Histogram& stat) override {
    begin(stat);
    open('[');
    for (const uint64_t count : stat.counts()) {
      next();
      number(count);
    }
    close(']');
    describe(stat);
    key("bins");
    open('{');
    member("low", stat.bins().low);
    member("high", stat.bins().high);
    member("step", stat.bins().step);
    close('}');
    close('}');
  }
  void visit(const stats::BreakdownBase& stat) override {
    begin(stat);
    open('{');
    for (const auto& [name, count] : stat.parts()) member(name, count);
    close('}');
    end(stat);
  }

 private:
  // Holds the names of an open object's members. An array has none.
  struct Level {
    std::vector<std::string_view> names;
    bool is_empty = true;
  };

  void open(char bracket) {
    out_ += bracket;
    levels_.emplace_back();
  }
  void close(char bracket) {
    const bool is_empty = levels_.back().is_empty;
    levels_.pop_back();
    if (!is_empty) new_line();
    out_ += bracket;
  }
  void new_line() { out_.append(1, '\n').append(2 * levels_.size(), ' '); }
  void next() {
    if (!levels_.back().is_empty) out_ += ',';
    levels_.back().is_empty = false;
    new_line();
  }
  void key(std::string_view name) {
    std::vector<std::string_view>& names = levels_.back().names;
    const bool is_new = std::ranges::find(names, name) == names.end();
    GLINT_CHECK(is_new, "two statistics or groups are both named '{}'", name);
    names.push_back(name);
    next();
    string(name);
    out_ += ": ";
  }
  void string(std::string_view text) {
    const bool is_plain =
        std::ranges::all_of(text, [](char c) { return c >= ' ' && c < 127 && c != '"' && c != '\\'; });
    if (is_plain)
      out_.append(1, '"').append(text) += '"';
    else
      out_ += nlohmann::json(text).dump();
  }
  void number(uint64_t value) {
    const fmt::format_int text(value);
    out_.append(text.data(), text.size());
  }
  void member(std::string_view name, uint64_t value) {
    key(name);
    number(value);
  }
  void fraction(const stats::Stat& stat, double value) {
    begin(stat);
    out_ += nlohmann::json(value).dump();
    end(stat);
  }
  void begin(const stats::Stat& stat) {
    key(stat.name());
    open('{');
    key("value");
  }
  void describe(const stats::Stat& stat) {
    key("unit");
    string(stat.unit());
    key("doc");
    string(stat.doc());
  }
  void end(const stats::Stat& stat) {
    describe(stat);
    close('}');
  }

  std::string out_;
  std::vector<Level> levels_;
};

class JsonWriter final : public StatWriter {
 public:
  static constexpr const char* kName = "json";
  static constexpr const char* kDoc = "Writes a tree with value, unit and description of every statistic.";
  using Params = NoParams;
  JsonWriter(Params, Context) {}

  std::string write(const stats::Group& root) const override {
    JsonVisitor visitor;
    root.accept(visitor);
    return std::move(visitor).text();
  }
};

const Register<StatWriter, JsonWriter> registered;

}  // namespace
}  // namespace glint::report
