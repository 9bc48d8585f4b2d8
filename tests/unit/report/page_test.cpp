// Tests the report's document and the comparison of runs, from texts.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/page.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/diagnostics.h"
#include "report/files/base64.h"
#include "report/files/config_rows.h"
#include "report/metrics/compare.h"
#include "report/page/stats.h"
#include "tests/support/catch.h"

using namespace glint;
using Json = nlohmann::ordered_json;

namespace {

report::RunRecord run(const std::string& cycles, const std::string& lanes) {
  report::RunRecord out;
  out.add_stats("path,value,unit,doc\ngpu.cycles," + cycles + ",cycle,\ngpu.core[0].lane_instructions," +
                    lanes + ",instruction,\n",
                "stats.csv");
  return out;
}

}  // namespace

TEST_CASE("base64 pads as RFC 4648 shows") {
  CHECK(report::base64("") == "");
  CHECK(report::base64("f") == "Zg==");
  CHECK(report::base64("fo") == "Zm8=");
  CHECK(report::base64("foobar") == "Zm9vYmFy");
  CHECK(report::base64("\xff\xfe") == "//4=");
}

TEST_CASE("a configuration file reads back with units and strings, whatever stands in a comment") {
  const auto rows = report::config_rows(
      "# title = 1\ncores = 8  # [core] Cores = many. (1 to 256)\n\n[core.units]\nissue = \"g#to\"  # Which "
      "# warp.\n");

  REQUIRE(rows.size() == 2);
  CHECK(rows[0].key == "cores");
  CHECK(rows[0].value == "8");
  CHECK(rows[0].unit == "core");
  CHECK(rows[0].doc == "Cores = many. (1 to 256)");
  CHECK(rows[1].key == "core.units.issue");
  CHECK(rows[1].value == "g#to");
  CHECK(rows[1].unit == "");
}

TEST_CASE("only keys with another value than the preset's are changes") {
  const auto changes = report::config_changes(report::config_rows("a = 1\nb = 2\nc = 3\n"),
                                              report::config_rows("a = 1\nb = 5\n"));

  REQUIRE(changes.size() == 2);
  CHECK(changes[0].row.key == "b");
  CHECK(changes[0].preset == "5");
  CHECK(changes[1].row.key == "c");
  CHECK(changes[1].preset == "");
}

TEST_CASE("instances of a unit stand side by side, and what is zero everywhere is one zero") {
  const Json stats = Json::parse(
      R"({"gpu": {"core[0]": {"hits": {"value": {"a": 1, "b": 0}, "unit": "x", "doc": "d"}, "late": {"value": [1, 0, 2, 0], "unit": "y", "doc": "e"}},
                                              "core[1]": {"hits": {"value": {"a": 0, "b": 0}, "unit": "x", "doc": "d"}, "late": {"value": [0, 0, 0, 0], "unit": "y", "doc": "e"}}}})");
  Json docs = Json::object();

  const Json out = report::page_stats(stats, docs);

  CHECK(out["gpu.core[*].hits::a"] == Json({1, 0}));
  CHECK(out["gpu.core[*].hits::b"] == 0);
  CHECK(out["gpu.core[*].late"] == Json::parse("[[1, 0, 2], []]"));
  CHECK(docs["gpu.core[*].hits"] == Json({{"unit", "x"}, {"doc", "d"}}));
}

TEST_CASE("a statistic without a number is damage, in its table as in its tree") {
  Json docs = Json::object();
  for (const char* value : {"null", "\"x\"", "[1, null]", "{\"a\": true}"})
    CHECK_THROWS_AS(report::page_stats(Json::parse(R"({"gpu": {"hits": {"value": )" + std::string(value) +
                                                   R"(, "unit": "x", "doc": "d"}}})"),
                                       docs),
                    UserError);
  for (const char* value : {"nan", "inf", "", "12x"}) CHECK_THROWS_AS(run(value, "3000"), UserError);
}

TEST_CASE("metrics that only one run has are named") {
  report::RunRecord cut;
  cut.add_stats("path,value,unit,doc\ngpu.cycles,900,cycle,\n", "stats.csv");
  const std::string text = report::uncompared_text(run("1000", "3000"), cut);

  CHECK(text.find("metrics are only in A: insn, thread_ipc") != std::string::npos);
  CHECK(text.find("only B") == std::string::npos);
  CHECK(text.find("cycles") == std::string::npos);
  CHECK(report::uncompared_text(cut, run("1000", "3000")).find("metrics are only in B: insn, thread_ipc") !=
        std::string::npos);
  CHECK(report::uncompared_text(cut, cut) == "");
}

TEST_CASE("changes are relative to the first run, and the largest comes first") {
  const auto changes = report::changes(run("1000", "3000"), run("900", "3000"));

  const auto of = [&](const std::string& name) {
    return *std::find_if(changes.begin(), changes.end(),
                         [&](const auto& c) { return c.metric->name == name; });
  };
  CHECK(*of("cycles").relative == Approx(-0.1));
  CHECK(*of("thread_ipc").relative == Approx(1.0 / 9));
  CHECK(*of("insn").relative == 0);
  CHECK(changes.front().metric->name != "insn");
  CHECK(changes.back().metric->name != "thread_ipc");
}

TEST_CASE("a condition holds on one side of its bound only") {
  const auto changes = report::changes(run("1000", "3000"), run("900", "3000"));

  CHECK(report::holds(report::parse_condition("cycles<-9%"), changes));
  CHECK_FALSE(report::holds(report::parse_condition("cycles<-11%"), changes));
  CHECK(report::holds(report::parse_condition("thread_ipc>+11%"), changes));
  CHECK_FALSE(report::holds(report::parse_condition("thread_ipc>12%"), changes));
  CHECK_FALSE(report::holds(report::parse_condition("insn<0%"), changes));
  CHECK_THROWS_AS(report::holds(report::parse_condition("dram_util<0%"), changes), UserError);
}

TEST_CASE("a condition that is none is refused with the form that is expected") {
  for (const char* text : {"thread_ipc", "thread_ipc<2", "<2%", "thread_ipc<x%", "thread_ipc<%",
                           "thread_ipc<nan%", "thread_ipc>inf%", "ipcc<2%"})
    CHECK_THROWS_AS(report::parse_condition(text), UserError);
}

TEST_CASE("no text of a run can end the page's script") {
  const Json data = Json::parse(
      R"({"runs": [{"directory": "</script><b>", "run": {"scene": {"name": "<i>"}, "shader": "s", "config": {"name": "c"}}, "stats": {}, "metrics": {}, "config": {},
                                              "preset": {"name": "<u>", "changes": {}}}], "stat_docs": {}, "metric_docs": [], "key_docs": {}})");
  const report::PageParts parts{
      .frame = "<!--title--><!--style--><!--noscript--><!--sections--><!--data--><!--script-->",
      .style = "",
      .script = "run()",
      .unpack = ""};

  const std::string page = report::page(data, parts);

  CHECK(page.find("</script><b>") == std::string::npos);
  CHECK(page.find("<i>") == std::string::npos);
  CHECK(page.find("<u>") == std::string::npos);
  CHECK_THROWS_AS(report::page(data, {.frame = "", .style = "", .script = "", .unpack = ""}), UserError);
}

TEST_CASE("no text of a suite can end the page's script or be read as HTML") {
  const Json data = Json::parse(R"({"runs": [], "metric_docs": [], "stat_docs": {}, "key_docs": {},
      "characterizations": [{"source": "</script><b>", "missing": "glint characterize <u>"}],
      "models": [{"source": "<s>", "models": [{"name": "<i>", "r2": 1, "mape": 0, "ratio": 1, "worst": "<em>", "worst_error": 0}],
                  "workloads": [{"name": "<q>", "cycles": 2, "predicted": [3]}]}]})");
  const report::PageParts parts{
      .frame = "<!--title--><!--style--><!--noscript--><!--sections--><!--data--><!--script-->",
      .style = "",
      .script = "run()",
      .unpack = ""};

  const std::string page = report::page(data, parts);

  for (const char* text : {"</script><b>", "<u>", "<s>", "<i>", "<em>", "<q>"})
    CHECK(page.find(text) == std::string::npos);
  CHECK(page.find("&lt;q&gt;") != std::string::npos);
  CHECK(page.find("id=\"configuration\"") == std::string::npos);
}
