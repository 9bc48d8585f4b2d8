// Implements the format `json` of statistics: a JSON tree in which groups are objects and a statistic is
// {"value", "unit", "doc"}.
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/check.h"
#include "report/files/stat_writer.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

class JsonVisitor final : public stats::Visitor {
 public:
  Json root = Json::object();

  void enter(const stats::Group& group) override { open_.push_back(&place(group.name(), Json::object())); }
  void leave(const stats::Group&) override { open_.pop_back(); }
  void visit(const stats::Counter& stat) override { add(stat, stat.value()); }
  void visit(const stats::Ratio& stat) override { add(stat, stat.value()); }
  void visit(const stats::Value& stat) override { add(stat, stat.value()); }
  void visit(const stats::Histogram& stat) override {
    Json& made = add(stat, stat.counts());
    made["bins"] = {{"low", stat.bins().low}, {"high", stat.bins().high}, {"step", stat.bins().step}};
  }
  void visit(const stats::BreakdownBase& stat) override {
    Json parts = Json::object();
    for (const auto& [name, count] : stat.parts()) parts[std::string(name)] = count;
    add(stat, std::move(parts));
  }

 private:
  Json& place(const std::string& name, Json value) {
    Json& parent = open_.empty() ? root : *open_.back();
    GLINT_CHECK(!parent.contains(name), "two statistics or groups are both named '{}'", name);
    return parent[name] = std::move(value);
  }
  Json& add(const stats::Stat& stat, Json value) {
    return place(
        std::string(stat.name()),
        {{"value", std::move(value)}, {"unit", std::string(stat.unit())}, {"doc", std::string(stat.doc())}});
  }

  // Pointers stay valid: ordered_json may move an object's members when it grows, but only the innermost open
  // object grows, and nobody holds a pointer into that one.
  std::vector<Json*> open_;
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
    return visitor.root.dump(2) + "\n";
  }
};

const Register<StatWriter, JsonWriter> registered;

}  // namespace
}  // namespace glint::report
