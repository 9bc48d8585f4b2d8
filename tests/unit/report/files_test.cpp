// Tests images, resolved configurations and run directories as files.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/config.h"
#include "base/diagnostics.h"
#include "report/files/config_file.h"
#include "report/files/run_directory.h"
#include "report/files/run_facts.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace glint::report {
namespace {
namespace fs = std::filesystem;
using test::TemporaryFolder;

const std::vector<ParamInfo> kParams{{"core.warps", "warp", "Warps.", "32", "1 to 64"},
                                     {"core.units.fp32.latency", "cycle", "Latency.", "4", "1 to 1000"},
                                     {"core.issue", "", "Policy.", "\"gto\"", "gto, lrr"},
                                     {"clock", "MHz", "Clock.", "1365.0", ""}};

TEST_CASE("a resolved configuration loads back to the same values") {
  const std::string text = config_file(kParams, "title");
  Config config;
  config.add_text("config.toml", text);
  Diagnostics diagnostics;
  ConfigTable root = config.root(diagnostics);
  ConfigTable core = root.take_table("core");

  CHECK(root.take_number("clock", 0, 0, 1e9, "") == 1365.0);
  CHECK(core.take_integer("warps", 0, 0, 100, "") == 32);
  CHECK(core.take_name("issue", "", {"gto"}) == "gto");
  CHECK(core.take_table("units").take_table("fp32").take_integer("latency", 0, 0, 100, "") == 4);
  CHECK_FALSE(diagnostics.has_errors());
}

TEST_CASE("a resolved configuration says unit, meaning and range beside each key, tables once") {
  CHECK(config_file(kParams, "title") ==
        "# title\n"
        "clock = 1365.0  # [MHz] Clock.\n"
        "\n[core]\n"
        "warps = 32     # [warp] Warps. (1 to 64)\n"
        "issue = \"gto\"  # Policy. (gto, lrr)\n"
        "\n[core.units.fp32]\n"
        "latency = 4  # [cycle] Latency. (1 to 1000)\n");
}

TEST_CASE("a configuration's hash is FNV-1a of its keys and values and ignores the docs") {
  CHECK(fnv1a("") == 0xcbf29ce484222325);
  CHECK(fnv1a("a") == 0xaf63dc4c8601ec8c);  // a published test vector
  auto other = kParams;
  other[0].doc = "other";
  CHECK(config_key_values(other) == config_key_values(kParams));
  other[0].value = "31";
  CHECK(config_key_values(other) != config_key_values(kParams));
}

TEST_CASE("a run directory is complete and leaves no temporary file") {
  const TemporaryFolder folder;
  const RunDirectory directory((folder.path / "a/b").string());
  stats::Group root(nullptr, "gpu");
  stats::Counter counter(&root, "cycles", "cycle", "Cycles.");
  directory.write_image({1, 2, std::vector<float>(8, 0.5f)}, 1);
  directory.write_stats(root);
  directory.write_config(kParams, "t");
  RunInfo info;
  info.command = {"glint", "run", "bad \xff byte"};
  info.scene_hash = 0xab;
  directory.write_run(info);

  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory.path())) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"config.toml", "image.pfm", "image.png", "run.json", "stats.csv",
                                          "stats.json", "stats.txt"});
  const auto json = nlohmann::json::parse(folder.read("a/b/run.json"));
  CHECK(json.at("scene").at("hash") == "00000000000000ab");
  CHECK(json.at("exit") == 0);
}

TEST_CASE("a run begins in an empty folder or one of a run, and in no other") {
  const TemporaryFolder folder;
  const std::string path = (folder.path / "run").string();
  RunInfo info;
  info.command = {"glint", "run"};
  {
    RunDirectory directory(path);
    directory.begin(info);
    CHECK(nlohmann::json::parse(folder.read("run/run.json")).at("exit") == int(Exit::Failure));
    directory.write("stats.csv", "a result");
    directory.write("heat/maps.json", R"({"maps": [{"name": "rays"}, {"name": "../stats"}, 7]})");
    for (const char* name : {"heat/rays.png", "heat/mine.png", "mine.txt"}) directory.write(name, "x");
    CHECK_THROWS_AS(RunDirectory(path).begin(info), UserError);  // The first one still runs.
  }
  CHECK_FALSE(fs::exists(path + "/glint.lock"));
  std::ofstream(path + "/glint.lock") << "";  // as a killed process leaves it
  RunDirectory(path).begin(info);
  for (const char* name : {"stats.csv", "heat/maps.json", "heat/rays.png"})
    CHECK_FALSE(fs::exists(folder.path / "run" / name));
  for (const char* name : {"run.json", "heat/mine.png", "mine.txt"})
    CHECK(fs::exists(folder.path / "run" / name));

  fs::remove(path + "/run.json");
  CHECK_THROWS_AS(RunDirectory(path).begin(info), UserError);
  CHECK(folder.read("run/mine.txt") == "x");
}

TEST_CASE("what a run saves replaces only what an earlier run has saved") {
  const TemporaryFolder folder;
  RunInfo info;
  info.command = {"glint", "run"};
  RunDirectory(folder.path.string()).begin(info);
  std::ofstream(folder.path / "kept.bin") << "mine";
  info.saved = {"kept.bin"};
  CHECK_THROWS_AS(RunDirectory(folder.path.string()).begin(info), UserError);
  CHECK(folder.read("kept.bin") == "mine");
  fs::remove(folder.path / "kept.bin");
  RunDirectory(folder.path.string()).begin(info);
  std::ofstream(folder.path / "kept.bin") << "the run's";
  info.saved = {};
  RunDirectory(folder.path.string())
      .begin(info);  // It finds the list that the run before left as it was killed.
  CHECK_FALSE(fs::exists(folder.path / "kept.bin"));
}

TEST_CASE("facts of other types than a run writes are named") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path);
  const std::string path = (folder.path / "run.json").string();
  const auto read = [&](const std::string& text) {
    std::ofstream(path) << text;
    return read_run_facts(path);
  };
  CHECK(read(R"({"schema": 1, "scene": {"name": "a"}, "other": 7})").at("scene").at("name") == "a");
  for (const char* text : {R"({"mode": 7})", R"({"scene": {"name": null}})", R"({"schema": "1"})", "[]", "{"})
    CHECK_THROWS_AS(read(text), UserError);
  CHECK_THROWS_AS(read_run_facts(folder.path.string()), UserError);  // a folder
}

TEST_CASE("an output folder that is a file is a user error") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path);
  std::ofstream(folder.path / "file") << "x";

  CHECK_THROWS_AS(RunDirectory((folder.path / "file").string()), UserError);
}

}  // namespace
}  // namespace glint::report
