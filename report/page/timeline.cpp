// Writes a timeline as the report's document has it, with numbers for names, so that it stays small.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/timeline.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

// Gives texts numbers in the order in which they first appear.
class Names {
 public:
  size_t of(const std::string& name) {
    const auto [found, is_new] = numbers_.try_emplace(name, numbers_.size());
    if (is_new) list_.push_back(name);
    return found->second;
  }
  const Json& list() const { return list_; }

 private:
  std::map<std::string, size_t> numbers_;
  Json list_ = Json::array();
};

}  // namespace

Json page_timeline(const Timeline& timeline) {
  Names kinds, names;
  Json slices = Json::array();
  for (const Timeline::Slice& slice : timeline.slices) {
    Json row = {slice.thread, kinds.of(slice.kind), slice.begin - timeline.begin, slice.length,
                names.of(slice.name)};
    for (const char* arg : {"rays", "nodes"})
      if (const auto found = slice.args.find(arg); found != slice.args.end()) row.push_back(found->second);
    slices.push_back(std::move(row));
  }
  return {{"core", timeline.core},
          {"cores", timeline.cores},
          {"begin", timeline.begin},
          {"end", timeline.end},
          {"trace_begin", timeline.trace_begin},
          {"trace_end", timeline.trace_end},
          {"cut", timeline.is_cut},
          {"kinds", kinds.list()},
          {"names", names.list()},
          {"slices", std::move(slices)}};
}

}  // namespace glint::report
