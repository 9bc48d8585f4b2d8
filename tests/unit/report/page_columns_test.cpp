// Tests how the report's document is turned into columns.
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <vector>

#include "report/page/columns.h"
#include "tests/support/catch.h"

using namespace glint;
using Json = nlohmann::ordered_json;

namespace {

Json columns_of(const char* runs) {
  return report::page_columns({{"version", "1"}, {"runs", Json::parse(runs)}});
}

}  // namespace

TEST_CASE("what all runs have alike stands once, and what a run lacks is null in its place of the order") {
  const Json out = columns_of(
      R"([{"stats": {"a": [1], "c": [3]}, "metrics": {"m": 5.0}, "config": {"k": "x"}, "directory": "one"},
                                  {"stats": {"a": [1], "b": [2], "c": [4]}, "metrics": {"m": 5.5}, "config": {"k": "x"}, "directory": "two"}])");

  CHECK(out["stats"].dump() == R"({"a":[[1]],"b":[null,[2]],"c":[[3],[4]]})");
  CHECK(out["metrics"].dump() == R"({"m":[5,5.5]})");
  CHECK(out["config"].dump() == R"({"k":["x"]})");
  CHECK(out["runs"].dump() == R"([{"directory":"one"},{"directory":"two"}])");
}

TEST_CASE("a statistic is left to a quotient only where the quotient is exact in every run and instance") {
  const Json out = columns_of(
      R"([{"stats": {"num": [1, 2], "den": [3, 0], "all": [7], "third": [0.3333333333333333, 0], "share": [0.14285714285714285, 0.2857142857142857], "off": [0.3333333333333333, 0.1]}},
                                  {"stats": {"num": [5, 1], "den": [2, 3], "all": [7], "third": [2.5, 0.3333333333333333], "share": [0.7142857142857143, 0.14285714285714285], "off": [2.5, 0.33333333333333337]}},
                                  {"stats": {"num": 0, "den": [2, 3], "all": [7], "third": 0, "share": 0, "off": 0}}])");

  CHECK(out["quotients"].dump() == R"({"third":["num","den"],"share":["num","all"]})");
  CHECK(out["stats"]["off"] == Json::parse("[[0.3333333333333333, 0.1], [2.5, 0.33333333333333337], 0]"));
  CHECK_FALSE(out["stats"].contains("third"));
}

TEST_CASE("a run without a statistic does not get it from a quotient") {
  const Json out = columns_of(
      R"([{"stats": {"num": [1], "den": [3], "third": [0.3333333333333333]}}, {"stats": {"num": [1], "den": [3]}}])");

  CHECK(out["quotients"].empty());
  CHECK(out["stats"]["third"] == Json::parse("[[0.3333333333333333], null]"));
}

TEST_CASE("listings of the same programs stand once, and pictures are left to the page") {
  const Json out = columns_of(
      R"([{"picture": "data:", "heat": [{"name": "rays", "picture": "data:", "max": 2}], "source": {"files": [1], "programs": [2], "counts": [[1, 2, 3, 4, 5, 6, 7, 8], [0, 9, 3, 4, 5, 6, 7, 8, 1, 20]]}},
                                  {"source": {"files": [1], "programs": [2], "counts": []}}, {"source": {"files": [1], "programs": [5], "counts": []}}])");

  CHECK(out["listings"] ==
        Json::parse(R"([{"files": [1], "programs": [2]}, {"files": [1], "programs": [5]}])"));
  CHECK(
      out["runs"].dump() ==
      R"([{"heat":[{"name":"rays","max":2}],"source":{"counts":[[1,0],[2,9],[3,3],[4,4],[5,5],[6,6],[7,7],[8,8],[[],[1,20]]],"listing":0}},)"
      R"({"source":{"counts":[[],[],[],[],[],[],[],[],[]],"listing":0}},{"source":{"counts":[[],[],[],[],[],[],[],[],[]],"listing":1}}])");
}

TEST_CASE(
    "with too many numbers for a small page, counts are added up over instances, and shares of an instance "
    "are left out") {
  Json stats = {{"count", std::vector<int>(100'001, 2)},
                {"share", {0.5, 0.25}},
                {"one", {0.5}},
                {"bins", Json::parse("[[1, 2], [], [1, 0, 3]]")},
                {"zero", 0},
                {"total", {7}}};
  const auto page = [&](size_t more) {
    stats["more"] = std::vector<int>(more, 1);
    return report::page_columns({{"runs", {{{"stats", stats}}}}})["stats"];
  };

  const Json few = page(99'900), many = page(100'000);

  CHECK(few["count"][0].size() == 100'001);
  CHECK(few["share"] == Json::parse("[[0.5, 0.25]]"));
  CHECK(
      many.dump() ==
      R"({"count":[[200002]],"one":[[0.5]],"bins":[[[2,2,3]]],"zero":[0],"total":[[7]],"more":[[100000]]})");
}

TEST_CASE("slices of a timeline stand by kind and thread, each behind the end of the one before") {
  const Json out = columns_of(
      R"([{"timeline": {"begin": 5, "slices": [[1, 0, 0, 10, 3], [2, 0, 0, 4, 3], [2, 1, 1, 2, 5, 7], [2, 0, 6, 1, 4], [1, 1, 3, 2, 5, 8]]}}])");

  CHECK(
      out["runs"][0]["timeline"].dump() ==
      R"({"begin":5,"slices":[[1,2,2,1,2],[0,0,0,1,1],[0,0,2,3,1],[10,4,1,2,2],[3,3,4,5,5],[null,null,null,8,7]]})");
}
