// Tests the index of an application, and what the report page shows of it.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/application.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/diagnostics.h"
#include "report/files/application_index.h"
#include "report/files/run_directory.h"
#include "tests/support/catch.h"

namespace {

using namespace glint;
using Json = nlohmann::ordered_json;

// Is a folder with one file, which ends with it.
struct IndexFolder {
  explicit IndexFolder(const std::string& index) {
    std::filesystem::create_directory(path);
    report::write_file(path + "/index.json", index);
  }
  ~IndexFolder() { std::filesystem::remove_all(path); }
  std::string path = (std::filesystem::temp_directory_path() / ("glint-index-" + std::to_string(::getpid())));
};

report::DeviceCommand dispatch(uint64_t number, std::optional<uint64_t> cycles, const std::string& shader) {
  report::DeviceCommand out;
  out.kind = "dispatch", out.number = number, out.shader = shader, out.size = {16, 2, 1};
  out.begin = number * 100, out.end = number * 100 + cycles.value_or(10), out.instructions = 7;
  out.cycles = cycles;
  if (cycles) out.folder = report::launch_folder(number, out.kind);
  return out;
}

report::ApplicationFacts facts() {
  report::ApplicationFacts out;
  out.program = "<u>", out.command = {"./<u>", "\xff"}, out.config = "mobile", out.timing = "all";
  out.has_ended = true;
  out.refused = {{"vkQueueSubmit", "<s>", 3}};
  return out;
}

std::string sections(const report::ApplicationIndex& index, const Json& links = Json::object()) {
  const IndexFolder folder(index.text(facts()));
  return report::application_sections(
      {{"applications",
        {{{"source", "x"}, {"index", report::read_application(folder.path)}, {"links", links}}}}});
}

}  // namespace

TEST_CASE("an index reads back what was added, and the commands with the most cycles come first") {
  report::ApplicationIndex index;
  index.add(dispatch(0, 30, "a"));
  index.add(dispatch(1, std::nullopt, "b"));
  index.add(dispatch(2, 50, "\xff"));
  report::DeviceCommand copy;
  copy.kind = "transfer", copy.count = 2, copy.bytes = 4096, copy.begin = 300, copy.end = 310;
  index.add(copy);
  CHECK(index.size() == 4);

  const IndexFolder folder(index.text(facts()));
  const Json json = report::read_application(folder.path);

  CHECK(json["commands"][0]["size"] == Json({16, 2, 1}));
  CHECK(json["commands"][1]["cycles"].is_null());
  CHECK(json["commands"][3] ==
        Json({{"kind", "transfer"}, {"count", 2}, {"bytes", 4096}, {"begin", 300}, {"end", 310}}));
  CHECK(json["state"] == "ended");
  CHECK(report::timed_folders(json) == std::vector<std::string>{"launch-2-dispatch", "launch-0-dispatch"});
}

TEST_CASE("an index without commands is an index") {
  const IndexFolder folder(report::ApplicationIndex().text(facts()));
  CHECK(report::is_application_folder(folder.path));
  CHECK(report::read_application(folder.path)["commands"].empty());
}

TEST_CASE("what is no index is refused with its path") {
  const std::string good = report::ApplicationIndex().text(facts());
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"\"schema\": 2", "\"schema\": 1"},
           {"\"state\": \"ended\"", "\"state\": 7"},
           {"\"commands\": [", "\"commands\": [{\"kind\": \"dispatch\"}"},
           {"\"count\": 3", "\"count\": \"3\""}}) {
    std::string bad = good;
    bad.replace(bad.find(from), from.size(), to);
    const IndexFolder folder(bad);
    CHECK_THROWS_WITH(report::read_application(folder.path), Catch::Contains("index.json"));
  }
  CHECK_THROWS_AS(report::read_application("/nowhere"), UserError);
}

TEST_CASE("the sections of an application escape names and link the reports that there are") {
  report::ApplicationIndex index;
  report::DeviceCommand failed = dispatch(1, std::nullopt, "<i>");
  failed.error = "<q>", failed.label = "<em>";
  index.add(dispatch(0, 30, "a"));
  index.add(failed);
  index.add(dispatch(2, 50, "b"));

  const std::string text = sections(index, {{"launch-2-dispatch", "launch-2-dispatch/report.html"}});

  for (const char* hostile : {"<u>", "<s>", "<i>", "<q>", "<em>"})
    CHECK(text.find(hostile) == std::string::npos);
  CHECK_THAT(text, Catch::Contains("<a href=\"launch-2-dispatch/report.html\">dispatch 2</a>"));
  CHECK(text.find("launch-0-dispatch/report.html") == std::string::npos);
  CHECK(text.find(">dispatch 2<") < text.find(">dispatch 0<"));
  CHECK_THAT(text, Catch::Contains("62.5 %"));
  CHECK_THAT(text, Catch::Contains("vkQueueSubmit, 3 times"));
}

TEST_CASE("frames divide the launches of an application") {
  report::ApplicationIndex index;
  report::DeviceCommand frame;
  frame.kind = "present", frame.size = {320, 200, 1}, frame.file = "present-0000.png";
  frame.begin = frame.end = 100;
  report::DeviceCommand second = dispatch(1, 50, "b");
  second.frame = 1;
  index.add(dispatch(0, 30, "a"));
  index.add(frame);
  index.add(second);

  const std::string text = sections(index);
  CHECK_THAT(text, Catch::Contains("1 frames were presented"));
  CHECK_THAT(text, Catch::Contains("<a href=\"present-0000.png\">present-0000.png</a>"));
  CHECK_THAT(text, Catch::Contains("frame 0 ends at cycle 100"));
  CHECK_THAT(text, Catch::Contains("had 2 launches"));
}

TEST_CASE("builds of structures are no launches and have a lane of their own") {
  report::ApplicationIndex index;
  report::DeviceCommand build;
  build.kind = "build", build.structure = "<b>roof", build.is_top = true, build.is_update = true;
  build.count = 3, build.bytes = 1024, build.begin = build.end = 40, build.frame = 2;
  index.add(build);
  index.add(dispatch(0, 30, "a"));
  const IndexFolder folder(index.text(facts()));
  const Json json = report::read_application(folder.path);
  CHECK(json["commands"][0] == Json({{"kind", "build"},
                                     {"frame", 2},
                                     {"structure", "<b>roof"},
                                     {"level", "top"},
                                     {"primitives", 3},
                                     {"bytes", 1024},
                                     {"by", "device"},
                                     {"update", true},
                                     {"begin", 40},
                                     {"end", 40}}));
  CHECK(!report::is_launch(json["commands"][0]));
  CHECK(report::is_launch(json["commands"][1]));

  const std::string text = sections(index);
  CHECK_THAT(text, Catch::Contains("had 1 launches"));
  CHECK_THAT(text, Catch::Contains("update of the top level '&lt;b&gt;roof' of 3 instances, 1024 bytes"));
  CHECK_THAT(text, Catch::Contains("The 1 builds of acceleration structures take no simulated time"));
  CHECK(text.find("<b>") == std::string::npos);
}

TEST_CASE("a time line of many short commands has no more bars than it has places") {
  report::ApplicationIndex index;
  for (uint64_t i = 0; i < 20000; ++i) index.add(dispatch(i, std::nullopt, "a"));
  const std::string text = sections(index);
  size_t bars = 0;
  for (size_t at = text.find("<rect"); at != std::string::npos; at = text.find("<rect", at + 1)) ++bars;
  CHECK(bars > 500);
  CHECK(bars < 1500);
}
