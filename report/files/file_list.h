// Lists what the files of a folder held when they were written, so that readers notice a damaged one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::report {

// Stands for the contents of a file. Choice: CRC-32 finds every cut and every accident, costs a nanosecond
// for a byte or less, and is in zlib and in Python. It does not protect from a forger.
struct FileSum {
  uint64_t bytes = 0;
  uint32_t crc32 = 0;
  bool operator==(const FileSum&) const = default;
};
FileSum sum_of(std::string_view bytes);

using FileList = std::map<std::string, FileSum>;  // by name in the folder, such as "heat/rays.png"

// Convert the list to and from {"NAME": {"bytes": 12, "crc32": "0f1e2d3c"}}. `path` is the file that has the
// list. The second function throws UserError when an entry is none.
nlohmann::ordered_json json_of(const FileList& list);
FileList file_list(const nlohmann::ordered_json& json, const std::string& path);

// Reads the files of a folder, and refuses those that differ from the folder's list.
class ListedFiles {
 public:
  // Reads run.json of a run directory. Throws UserError as read_run_facts() does.
  static ListedFiles of_run(const std::string& directory);
  // `index` is the file that has the list, and `advice` says how to get whole files again. Without a list,
  // every file counts as whole.
  ListedFiles(std::string directory, std::string index, std::string advice, std::optional<FileList> list);

  std::string path_of(const std::string& name) const { return directory_ + "/" + name; }
  bool has_list() const { return list_.has_value(); }
  // Returns the bytes of a file, or nullopt when there is none. Throws UserError when the list has another
  // length or other contents for it.
  std::optional<std::string> read(const std::string& name) const;
  std::string need(const std::string& name) const;  // as read(); throws UserError when there is no such file
  // Returns the names in the list whose files are not there.
  std::vector<std::string> gone() const;

 private:
  std::string directory_, index_, advice_;
  std::optional<FileList> list_;
};

}  // namespace glint::report
