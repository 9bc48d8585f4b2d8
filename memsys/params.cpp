// Checks which memory configurations are impossible, and names the choices.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/params.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

#include "memsys/messages/packet.h"

namespace glint::mem {
namespace {

class Checker {
 public:
  Checker(Diagnostics& diagnostics, const std::string& section)
      : diagnostics_(diagnostics), section_(section) {}

  void require(bool ok, const std::string& what, const std::string& note = {}) {
    if (!ok) diagnostics_.error({}, with_section(what), note);
  }
  void at_least_one(const char* key, uint64_t value, const char* why) {
    require(value >= 1, fmt::format("'{}' is 0, expected at least 1", key), why);
  }
  void cache(const char* key, uint64_t size, uint32_t ways, uint32_t line) {
    if (!std::has_single_bit(line)) return;  // check() reports it
    require(size >= line,
            fmt::format("'{}' is {} bytes, expected at least one line of {} bytes", key, size, line));
    const uint64_t set = uint64_t{std::max(ways, 1u)} * line;
    if (size < line) return;
    require(size >= set,
            fmt::format("'{}' is {} bytes, expected at least one set: {} ways x {} bytes = {} bytes", key,
                        size, ways, line, set));
    require(size < set || size % set == 0,
            fmt::format("'{}' is {} bytes, expected a multiple of {} bytes ({} ways x {} bytes)", key, size,
                        set, std::max(ways, 1u), line));
  }

 private:
  // Puts the section in front of each key, because messages quote keys and nothing else.
  std::string with_section(const std::string& what) const {
    std::string out;
    bool opens = true;
    for (char c : what) {
      out += c;
      if (c != '\'') continue;
      if (opens) out += section_;
      opens = !opens;
    }
    return out;
  }

  Diagnostics& diagnostics_;
  const std::string section_;
};

void check_dram(const DramParams& d, uint32_t line, uint32_t interleave, Checker& c) {
  c.at_least_one("dram.channels", d.channels, "a machine has at least one memory partition");
  c.at_least_one("dram.queue", d.queue, "the scheduler needs an entry for the request that it serves");
  c.at_least_one("dram.transfers_per_clock", d.transfers_per_clock, "data must move");
  c.require(d.bank_groups >= 1 && d.banks >= d.bank_groups && d.banks % d.bank_groups == 0,
            fmt::format("'dram.banks' is {}, expected a multiple of 'dram.bank_groups' = {}", d.banks,
                        d.bank_groups));
  c.require(!std::has_single_bit(interleave) || (d.row_bytes >= interleave && d.row_bytes % interleave == 0),
            fmt::format("'dram.row_bytes' is {}, expected a multiple of 'interleave' = {}", d.row_bytes,
                        interleave));
  const uint32_t atom = d.atom_bytes();
  c.require(std::has_single_bit(atom) && atom >= 8 && atom <= line,
            fmt::format("'dram.bus_bytes' x 'dram.burst' is {} bytes, expected a power of two from 8 to the "
                        "line of {} bytes",
                        atom, line));
  c.require(d.transfers_per_clock == 0 || d.burst % d.transfers_per_clock == 0,
            fmt::format("'dram.burst' is {}, expected a multiple of 'dram.transfers_per_clock' = {}", d.burst,
                        d.transfers_per_clock));
  c.require(d.banks <= 64, fmt::format("'dram.banks' is {}, expected at most 64", d.banks));
  const bool per_bank = d.refresh == "per_bank";
  // The time includes the closing of a row that has just been opened.
  const double refresh = (per_bank ? d.rfc_bank : d.rfc) + d.ras + d.rp;
  c.require(
      d.refresh == "none" || d.refi > refresh,
      fmt::format("'dram.refi' is {} ns, expected more than the {} ns of '{}', 'dram.ras' and 'dram.rp'",
                  d.refi, refresh, per_bank ? "dram.rfc_bank" : "dram.rfc"),
      "nothing but refreshes would ever happen");
  c.require(d.rc + 1e-9 >= d.ras,
            fmt::format("'dram.rc' is {} ns, expected at least 'dram.ras' = {} ns", d.rc, d.ras));
}

}  // namespace

void check(const Params& p, Diagnostics& diagnostics, const std::string& section) {
  Checker c(diagnostics, section);
  c.require(std::has_single_bit(p.line) && p.line >= kSectorBytes && p.line <= 8 * kSectorBytes,
            fmt::format("'line' is {} bytes, expected a power of two from 32 to 256", p.line));
  c.require(std::has_single_bit(p.interleave) && p.interleave >= p.line,
            fmt::format("'interleave' is {} bytes, expected a power of two of at least the line of {} bytes",
                        p.interleave, p.line));
  c.cache("l1.size", p.l1.size, p.l1.ways, p.line);
  c.cache("l2.slice_size", p.l2.slice_size, p.l2.ways, p.line);
  c.at_least_one("l1.ports", p.l1.ports, "no access would ever be taken");
  c.at_least_one("l1.banks", p.l1.banks, "no access would ever be taken");
  c.at_least_one("l1.mshr_entries", p.l1.mshr_entries, "no miss could ever leave the cache");
  c.at_least_one("l1.mshr_merges", p.l1.mshr_merges, "the read that misses itself waits in the entry");
  c.at_least_one("l1.miss_queue", p.l1.miss_queue, "no miss could ever leave the cache");
  c.at_least_one("l2.mshr_entries", p.l2.mshr_entries, "no miss could ever leave the slice");
  c.at_least_one("l2.mshr_merges", p.l2.mshr_merges, "the read that misses itself waits in the entry");
  c.at_least_one("l2.sectors_per_cycle", p.l2.sectors_per_cycle, "no request would ever be served");
  // A miss of a whole line and the write-back of its victim must fit.
  const uint32_t whole_line = 2 * p.line / kSectorBytes;
  c.require(
      p.l2.dram_queue >= whole_line,
      fmt::format("'l2.dram_queue' is {}, expected at least {}: the sectors of a line and of its victim",
                  p.l2.dram_queue, whole_line));
  c.at_least_one("noc.core_request_bytes", p.noc.core_request_bytes, "packets must move");
  c.at_least_one("noc.core_reply_bytes", p.noc.core_reply_bytes, "packets must move");
  c.at_least_one("noc.partition_request_bytes", p.noc.partition_request_bytes, "packets must move");
  c.at_least_one("noc.partition_reply_bytes", p.noc.partition_reply_bytes, "packets must move");
  c.require(p.l1.allocate != "on_miss" || p.l1.miss_queue >= 2,
            fmt::format("'l1.miss_queue' is {}, expected at least 2: a miss and the write-back of its victim",
                        p.l1.miss_queue));
  c.require(
      !p.l1.write_allocate || p.l1.miss_queue >= 2,
      fmt::format("'l1.miss_queue' is {}, expected at least 2: a write and the write-back of its victim",
                  p.l1.miss_queue));
  c.require(p.l1.banks <= 64, fmt::format("'l1.banks' is {}, expected at most 64", p.l1.banks));
  c.require(p.noc.sides <= p.num_slices() || p.num_slices() == 0,
            fmt::format("'noc.sides' is {}, expected at most the {} slices", p.noc.sides, p.num_slices()));
  c.require(
      p.noc.sides > 1 || p.noc.far_latency == 0,
      fmt::format("'noc.far_latency' is {}, and 'noc.sides' is 1: nothing lies far", p.noc.far_latency));
  c.require(p.num_slices() <= 4096,
            fmt::format("'dram.channels' x 'l2.slices' is {}, expected at most 4096", p.num_slices()));
  c.require(
      p.hash != "classes" || SliceClasses::fits(p.num_slices()),
      fmt::format("'hash' is classes, and 'dram.channels' x 'l2.slices' is {}, expected 64, 80, 96 or 128",
                  p.num_slices()),
      "set 'hash' to mixed");
  check_dram(p.dram, p.line, p.interleave, c);
}

std::vector<std::string> l1_allocations() {
  return {"on_fill", "on_miss"};
}
std::vector<std::string> partition_hashes() {
  return {"mixed", "classes", "none"};
}

}  // namespace glint::mem
