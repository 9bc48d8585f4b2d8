// Compares files with the list of their folder.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/file_list.h"

#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <utility>
#include <zlib.h>

#include "base/diagnostics.h"
#include "base/regular_file.h"
#include "report/files/run_facts.h"

namespace glint::report {
namespace {

std::string hex_of(uint32_t crc32) {
  return fmt::format("{:08x}", crc32);
}

// Says how the file differs from what the list has of it.
std::string difference_of(const FileSum& is, const FileSum& was, const std::string& index) {
  if (is.bytes != was.bytes)
    return fmt::format("the file has {} bytes, and {} says {}: {}", is.bytes, index, was.bytes,
                       is.bytes < was.bytes ? "it was cut short" : "something was added to it");
  return fmt::format("the contents of the file have CRC-32 {}, and {} says {}: it was changed",
                     hex_of(is.crc32), index, hex_of(was.crc32));
}

}  // namespace

FileSum sum_of(std::string_view bytes) {
  return {bytes.size(), uint32_t(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()))};
}

nlohmann::ordered_json json_of(const FileList& list) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for (const auto& [name, sum] : list) out[name] = {{"bytes", sum.bytes}, {"crc32", hex_of(sum.crc32)}};
  return out;
}

FileList file_list(const nlohmann::ordered_json& json, const std::string& path) {
  FileList out;
  for (const auto& [name, entry] : json.items()) {
    const std::string text = entry.is_object() ? entry.value("crc32", nlohmann::ordered_json("")).dump() : "";
    FileSum& sum = out[name];
    const char *begin = text.data() + 1, *end = begin + 8;  // The text has quotes around it.
    const bool is_sum = text.size() == 10 && std::from_chars(begin, end, sum.crc32, 16).ptr == end;
    if (!is_sum || !entry.contains("bytes") || !entry["bytes"].is_number_unsigned())
      throw UserError({path}, fmt::format("'files/{}' has no length and CRC-32 of a file", name),
                      "the file is damaged; run it again");
    sum.bytes = entry["bytes"].get<uint64_t>();
  }
  return out;
}

ListedFiles ListedFiles::of_run(const std::string& directory) {
  const std::string path = directory + "/run.json";
  const nlohmann::ordered_json facts = read_run_facts(path);
  std::optional<FileList> list;
  if (facts.contains("files")) list = file_list(facts["files"], path);
  return {directory, "run.json", "run it again", std::move(list)};
}

ListedFiles::ListedFiles(std::string directory, std::string index, std::string advice,
                         std::optional<FileList> list)
    : directory_(std::move(directory)),
      index_(std::move(index)),
      advice_(std::move(advice)),
      list_(std::move(list)) {
}

std::optional<std::string> ListedFiles::read(const std::string& name) const {
  const std::string path = path_of(name);
  std::optional<std::string> bytes = read_regular_file(path);
  if (!bytes || !list_) return bytes;
  const auto listed = list_->find(name);
  if (listed == list_->end()) return bytes;
  if (const FileSum sum = sum_of(*bytes); sum != listed->second)
    throw UserError({path}, difference_of(sum, listed->second, index_), advice_);
  return bytes;
}

std::string ListedFiles::need(const std::string& name) const {
  std::optional<std::string> bytes = read(name);
  if (!bytes && list_ && list_->contains(name))
    throw UserError({path_of(name)}, fmt::format("the file is gone, and {} lists it", index_), advice_);
  if (!bytes)
    throw UserError({path_of(name)}, "cannot read the file", "is this the directory of a finished run?");
  return std::move(*bytes);
}

std::vector<std::string> ListedFiles::gone() const {
  std::vector<std::string> out;
  std::error_code error;
  if (list_)
    for (const auto& [name, sum] : *list_)
      if (!std::filesystem::exists(path_of(name), error)) out.push_back(name);
  return out;
}

}  // namespace glint::report
