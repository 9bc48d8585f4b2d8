// Puts faults into words and collects them.
// SPDX-License-Identifier: Apache-2.0
#include "exec/fault.h"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>

#include "isa/descriptors.h"

namespace glint::exec {

std::string_view name_of(FaultKind kind) {
  constexpr std::string_view kNames[] = {"out_of_bounds", "misaligned", "image",
                                         "record",        "structure",  "barrier"};
  static_assert(std::size(kNames) == size_t(FaultKind::Count));
  return kNames[size_t(kind)];
}

std::string Fault::to_string() const {
  return fmt::format("{}: fault: {}\n  note: launch id ({}, {}, {})", place, what, launch_id[0], launch_id[1],
                     launch_id[2]);
}

std::string FaultLog::Entry::to_string() const {
  return first.to_string() + (count > 1 ? fmt::format(", the first of {} times", count) : "");
}

void FaultLog::note(uint32_t pc, FaultKind kind, uint64_t launch_index,
                    const std::function<Fault()>& describe) {
  const auto [it, is_new] = entries_.try_emplace({pc, kind});
  Entry& entry = it->second;
  ++entry.count;
  if (!is_new && launch_index >= entry.launch_index) return;
  entry.pc = pc;
  entry.kind = kind;
  entry.launch_index = launch_index;
  entry.first = describe();
}

void FaultLog::add(const FaultLog& other) {
  for (const auto& [key, theirs] : other.entries_) {
    const auto [it, is_new] = entries_.try_emplace(key, theirs);
    if (is_new) continue;
    const uint64_t count = it->second.count + theirs.count;
    if (theirs.launch_index < it->second.launch_index) it->second = theirs;
    it->second.count = count;
  }
}

uint64_t FaultLog::count(FaultKind kind) const {
  uint64_t sum = 0;
  for (const auto& [key, entry] : entries_)
    if (entry.kind == kind) sum += entry.count;
  return sum;
}

std::vector<FaultLog::Entry> FaultLog::in_order() const {
  std::vector<Entry> out;
  for (const auto& [key, entry] : entries_) out.push_back(entry);
  std::sort(out.begin(), out.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.launch_index, a.pc, a.kind) < std::tie(b.launch_index, b.pc, b.kind);
  });
  return out;
}

std::string FaultLog::to_string() const {
  if (empty()) return {};
  std::string out;
  uint64_t times = 0;
  for (const Entry& entry : in_order()) {
    out += entry.to_string() + "\n";
    times += entry.count;
  }
  return out + fmt::format("warning: faults let pass: {}, at {} places; loads gave 0, stores were dropped",
                           times, entries_.size());
}

std::string FaultLog::with(const Fault& last) const {
  return empty() ? last.to_string() : to_string() + "\n" + last.to_string();
}

std::string whereabouts(const mem::AddressSpace& memory, Address address, uint64_t bytes) {
  if (memory.find(address, bytes)) return memory.describe(address);
  if (const auto place = isa::unbound_place(address))
    return fmt::format("set {} binding {}, to which nothing is bound", place->set, place->binding);
  return memory.explain(address, bytes);
}

}  // namespace glint::exec
