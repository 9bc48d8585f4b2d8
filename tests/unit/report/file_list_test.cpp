// Tests that a file which is not as its folder lists it is refused, and named with what differs.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/file_list.h"

#include <nlohmann/json.hpp>

#include "base/diagnostics.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace glint::report {
namespace {
using Catch::Contains;
using test::TemporaryFolder;

TEST_CASE("the sum of a text is its length and the CRC-32 of RFC 1952") {
  CHECK(sum_of("") == FileSum{0, 0});
  CHECK(sum_of("123456789") == FileSum{9, 0xcbf43926});  // the check value of that CRC
}

TEST_CASE("a list of files survives its JSON, and anything else is refused") {
  const FileList list = {{"stats.csv", {12, 0x0f}}, {"heat/rays.png", {uint64_t{1} << 40, 0xffffffff}}};
  CHECK(file_list(json_of(list), "run.json") == list);
  for (const char* text :
       {R"({"a": 7})", R"({"a": {"bytes": 1}})", R"({"a": {"bytes": 1, "crc32": 7}})",
        R"({"a": {"bytes": -1, "crc32": "00000000"}})", R"({"a": {"bytes": 1, "crc32": "0000000g"}})",
        R"({"a": {"bytes": 1, "crc32": "000000000"}})"})
    CHECK_THROWS_WITH(file_list(nlohmann::ordered_json::parse(text), "run.json"),
                      Contains("run.json") && Contains("files/a"));
}

TEST_CASE("a file is read when it is as listed, and refused when its length or contents differ") {
  const TemporaryFolder folder;
  const ListedFiles files(folder.path.string(), "run.json", "run it again",
                          FileList{{"a.csv", sum_of("one\ntwo\n")}});
  CHECK(files.gone() == std::vector<std::string>{"a.csv"});
  CHECK_FALSE(files.read("a.csv"));
  CHECK_THROWS_WITH(files.need("a.csv"), Contains("the file is gone, and run.json lists it"));
  CHECK_THROWS_WITH(files.need("b.csv"), Contains("is this the directory of a finished run?"));
  folder.write("a.csv", "one\ntwo\n");
  CHECK(files.need("a.csv") == "one\ntwo\n");
  CHECK(files.gone().empty());
  folder.write("a.csv", "one\n");
  CHECK_THROWS_WITH(files.read("a.csv"), Contains("a.csv: error: the file has 4 bytes, and run.json says "
                                                  "8: it was cut short") &&
                                             Contains("run it again"));
  folder.write("a.csv", "one\ntwo\nthree\n");
  CHECK_THROWS_WITH(files.read("a.csv"), Contains("something was added to it"));
  folder.write("a.csv", "one\n2wo\n");
  CHECK_THROWS_WITH(files.read("a.csv"), Contains("CRC-32") && Contains("it was changed"));
}

TEST_CASE("without a list, and beside it, every file counts as whole") {
  const TemporaryFolder folder;
  folder.write("a.csv", "one\n");
  const ListedFiles none(folder.path.string(), "run.json", "", std::nullopt),
      empty(folder.path.string(), "run.json", "", FileList{});
  CHECK_FALSE(none.has_list());
  CHECK(none.need("a.csv") == "one\n");
  CHECK(empty.has_list());
  CHECK(empty.need("a.csv") == "one\n");
}

}  // namespace
}  // namespace glint::report
