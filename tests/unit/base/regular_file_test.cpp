// Tests reading of regular files.
// SPDX-License-Identifier: Apache-2.0
#include "base/regular_file.h"

#include <string_view>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace glint;

TEST_CASE("a file read on several threads has its bytes in order") {
  const test::TemporaryFolder folder;
  std::string text;
  while (text.size() < (40u << 20)) text += std::to_string(text.size()) + '\n';
  const std::string file = folder.write("numbers", text);
  REQUIRE(size_of_regular_file(file) == text.size());
  for (const uint32_t threads : {1u, 3u}) {
    std::vector<char> bytes(text.size());
    CHECK(read_regular_file(file, bytes, threads));
    CHECK(std::string_view(bytes.data(), bytes.size()) == text);
  }
  CHECK(read_regular_file(file) == text);
}

TEST_CASE("what has fewer bytes, or is no regular file, is not read on several threads") {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("short", "abc");
  std::vector<char> bytes(4);
  CHECK_FALSE(read_regular_file(file, bytes, 2));
  CHECK(read_regular_file(file, std::span(bytes).first(3), 2));
  CHECK_FALSE(read_regular_file(folder.path.string(), {}, 2));
  CHECK_FALSE(read_regular_file((folder.path / "absent").string(), {}, 2));
  CHECK(size_of_regular_file(folder.path.string()) == 0);
}
