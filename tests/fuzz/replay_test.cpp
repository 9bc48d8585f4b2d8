// Gives every input that the fuzzers keep to their entry points again, without a fuzzer.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/fuzz/entry.h"
#include "tests/support/catch.h"

using namespace glint;
namespace fs = std::filesystem;

namespace {

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> corpus(const std::string& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(fs::path(GLINT_SOURCE_DIR) / "tests/fuzz/corpus" / folder))
    out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

TEST_CASE("the programs of the corpus are sound, survive their text and run") {
  const auto files = corpus("asm");
  REQUIRE(files.size() >= 10);
  for (const fs::path& path : files) {
    INFO(path);
    const fuzz::Reached reached = fuzz::assembly(bytes_of(path));
    if (path.extension() == ".isa") CHECK(int(reached) == int(fuzz::Reached::Ran));
  }
}

TEST_CASE("programs spelt by bytes do no harm, and many of the corpus run") {
  int ran = 0, all = 0;
  for (const fs::path& path : corpus("verify")) {
    INFO(path);
    const std::string bytes = bytes_of(path);
    ran +=
        fuzz::program({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}) == fuzz::Reached::Ran;
    ++all;
  }
  // Op numbers change when the table grows, and then the same bytes spell another program.
  CHECK(ran * 20 >= all);
  CHECK(all >= 10);
}

TEST_CASE("damaged text is refused or does no harm") {
  std::mt19937 random(1);
  for (const fs::path& path : corpus("asm")) {
    INFO(path);
    const std::string good = bytes_of(path);
    for (int i = 0; i < 20 && !good.empty(); ++i) {
      std::string bad = good;
      for (int n = 0; n < 3; ++n) {
        const size_t at = random() % (bad.size() + 1), from = random() % good.size();
        bad.replace(at, random() % 6, good, from, random() % 6);
      }
      fuzz::assembly(bad);
    }
  }
}
