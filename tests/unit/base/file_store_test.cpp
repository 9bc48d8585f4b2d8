// Tests the store of files: values of both kinds, damaged files, and pages that belong to a process.
// SPDX-License-Identifier: Apache-2.0
#include "base/file_store.h"

#include <filesystem>

#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace glint;
using test::TemporaryFolder;

namespace {

FileStore store_in(const TemporaryFolder& folder) {
  return FileStore({folder.path.string(), ".value", "build", 1 << 20});
}

// Returns "head|rest" of a key, or "" when it is not found.
std::string both_of(FileStore& store, const std::string& key) {
  const std::optional<FileStore::Large> value = store.find_large(key);
  return value ? std::string(value->head) + '|' + std::string(value->rest, value->bytes) : "";
}

}  // namespace

TEST_CASE("values with and without a rest are found by their keys, each in its own way") {
  const TemporaryFolder folder;
  FileStore store = store_in(folder);
  const std::string rest(100'000, 'r');
  store.store("small", "a value");
  store.store("large", "head", rest);
  CHECK(store.find("small") == "a value");
  CHECK(both_of(store, "large") == "head|" + rest);
  CHECK_FALSE(store.find("large"));
  CHECK(both_of(store, "small").empty());
  CHECK_FALSE(store.find("absent"));
  CHECK(store.damaged() == 0);
}

TEST_CASE("a rest that was stored in pieces is one block, on any number of threads") {
  const TemporaryFolder folder;
  const std::string long_piece(20'000'000, 'p');  // more than the store hashes at a time
  const std::string_view pieces[] = {"one ", "", "two ", long_piece};
  for (const uint32_t threads : {1u, 3u}) {
    FileStore store({folder.path.string(), ".value", "build", 1 << 26, threads});
    if (threads == 1) store.store("key", "head", pieces);
    const bool is_same = both_of(store, "key") == "head|one two " + long_piece;
    CHECK(is_same);
  }
}

TEST_CASE("what is written to a found value stays in the process, and the value outlasts its file") {
  const TemporaryFolder folder;
  FileStore store = store_in(folder);
  store.store("key", "head", "the rest");
  const std::optional<FileStore::Large> value = store.find_large("key");
  REQUIRE(value);
  CHECK(reinterpret_cast<uintptr_t>(value->rest) % 4096 == 0);
  for (uint64_t i = 0; i < FileStore::kRestSlack; ++i) CHECK(value->rest[value->bytes + i] == 0);
  value->rest[0] = 'T';
  CHECK(both_of(store, "key") == "head|the rest");
  std::filesystem::remove(store.file_of("key"));
  CHECK(std::string(value->rest, value->bytes) == "The rest");
}

TEST_CASE("a file that is cut or changed anywhere is damaged and found no more") {
  const TemporaryFolder folder;
  FileStore store = store_in(folder);
  store.store("key", "head", "the rest");
  const std::string name = std::filesystem::path(store.file_of("key")).filename().string();
  const std::string good = folder.read(name);
  uint64_t damaged = 0;
  // Bytes that fill the page above the rest are not checked, because nobody reads them.
  for (const size_t at : {size_t{0}, size_t{8}, size_t{16}, size_t{24}, size_t{32}, size_t{41}, size_t{52},
                          size_t{4096}, good.size() - 1}) {
    std::string bad = good;
    bad[at] ^= 0x40;
    folder.write(name, bad);
    CAPTURE(at);
    CHECK(both_of(store, "key").empty());
    CHECK(store.damaged() == ++damaged);
  }
  for (const size_t size : {size_t{0}, size_t{1}, size_t{40}, size_t{4096}, good.size() - 1}) {
    folder.write(name, good.substr(0, size));
    CAPTURE(size);
    CHECK(both_of(store, "key").empty());
    CHECK(store.damaged() == ++damaged);
  }
  folder.write(name, good);
  CHECK(both_of(store, "key") == "head|the rest");
}
