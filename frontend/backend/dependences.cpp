// Follows registers and memory through a run, and notes who has to wait for whom.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/dependences.h"

#include <algorithm>
#include <utility>

#include "frontend/backend/memory_use.h"
#include "frontend/backend/slots.h"

namespace glint::frontend {
namespace {

struct LastAccess {
  std::vector<size_t> writers, readers;  // writers: the last unguarded write and the guarded ones since
};

}  // namespace

std::vector<Dependence> find_dependences(const std::vector<VirtualInst>& code,
                                         const std::function<uint32_t(const VirtualInst&)>& latency,
                                         uint32_t guard_latency) {
  std::vector<Dependence> out;
  const auto depend = [&](size_t from, size_t to, uint32_t delay) { out.push_back({from, to, delay}); };
  std::vector<std::pair<VirtualRegister, LastAccess>> accesses;  // sorted by register
  const auto access = [&](VirtualRegister r) -> LastAccess& {
    const auto at = std::lower_bound(accesses.begin(), accesses.end(), r,
                                     [](const auto& a, VirtualRegister b) { return a.first < b; });
    if (at != accesses.end() && at->first == r) return at->second;
    return accesses.insert(at, {r, {}})->second;
  };
  std::vector<std::pair<size_t, MemoryUse>> memory;
  for (size_t i = 0; i < code.size(); ++i) {
    for_each_use(code[i], [&](VirtualRegister r) {
      LastAccess& last = access(r);
      for (size_t w : last.writers) depend(w, i, latency(code[w]) + (r == code[i].guard ? guard_latency : 0));
      last.readers.push_back(i);
    });
    for_each_def(code[i], [&](VirtualRegister r) {
      LastAccess& last = access(r);
      for (size_t reader : last.readers)
        if (reader != i) depend(reader, i, 1);
      for (size_t w : last.writers)
        if (w != i) depend(w, i, 1);
      if (!is_guarded(code[i])) last.writers.clear();
      last.readers.clear();
      last.writers.push_back(i);
    });
    const MemoryUse use = memory_use(code[i]);
    if (!use.any) continue;
    for (const auto& [earlier, other] : memory)
      if (must_stay_in_order(other, use))
        depend(earlier, i, other.writes && !use.writes ? latency(code[earlier]) : 1);
    memory.emplace_back(i, use);
  }
  return out;
}

}  // namespace glint::frontend
