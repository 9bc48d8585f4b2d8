// Computes peak bandwidths and capacities, and the warnings that follow from them.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/peak.h"

#include <algorithm>
#include <fmt/format.h>

#include "memsys/messages/packet.h"

namespace glint::mem {
namespace {

double gigabytes(double bytes) {
  return bytes / 1e9;
}

// Returns the data bytes per cycle of a port when every reply has one sector. A reply takes whole cycles.
double data_rate(uint32_t port_bytes) {
  const uint32_t packet = kSectorBytes + kHeaderBytes;
  return double(kSectorBytes) / double((packet + port_bytes - 1) / port_bytes);
}

// Returns the larger of data_rate() and the rate of replies with a whole line, which fill wide ports better.
double best_data_rate(uint32_t port_bytes, uint32_t line) {
  const uint32_t packet = line + kHeaderBytes;
  return std::max(data_rate(port_bytes), double(line) / double((packet + port_bytes - 1) / port_bytes));
}

}  // namespace

Peak peak(const Params& p, uint32_t num_cores, double core_mhz) {
  const double hz = core_mhz * 1e6;
  const double slices = p.num_slices();
  Peak out;
  out.l1_bytes = p.l1.size * num_cores;
  out.l2_bytes = p.l2.slice_size * p.num_slices();
  out.l1_bandwidth = hz * num_cores * std::min(p.l1.ports, p.l1.banks) * p.line;
  out.core_ports = hz * num_cores * best_data_rate(p.noc.core_reply_bytes, p.line);
  out.slice_ports = hz * slices * best_data_rate(p.noc.partition_reply_bytes, p.line);
  out.l2_bandwidth = hz * slices * p.l2.sectors_per_cycle * kSectorBytes;
  out.dram_bandwidth =
      p.dram.channels * p.dram.clock_mhz * 1e6 * p.dram.transfers_per_clock * p.dram.bus_bytes;
  // A bank that is refreshed alone leaves the bus to the others.
  const double share = p.dram.refresh == "all_bank" ? p.dram.rfc / p.dram.refi : 0.0;
  out.dram_refreshed = out.dram_bandwidth * (1 - share);
  return out;
}

std::string Peak::to_string() const {
  return fmt::format(
      "L1 {} KiB at {:.1f} GB/s, network {:.1f} GB/s, L2 {} KiB at {:.1f} GB/s, DRAM {:.1f} GB/s",
      l1_bytes / 1024, gigabytes(l1_bandwidth), gigabytes(network()), l2_bytes / 1024,
      gigabytes(l2_bandwidth), gigabytes(dram_bandwidth));
}

void warn(const Params& p, uint32_t num_cores, double core_mhz, Diagnostics& diagnostics,
          const std::string& section) {
  const Peak best = peak(p, num_cores, core_mhz);
  const auto carries = [&](double offered, const char* what, double carried, const char* by,
                           const char* key) {
    if (offered <= carried * 1.0001) return;
    diagnostics.warning({}, fmt::format("{} could deliver {:.1f} GB/s and {} carry {:.1f} GB/s ('{}{}')",
                                        what, gigabytes(offered), by, gigabytes(carried), section, key));
  };
  carries(best.dram_bandwidth, "DRAM", best.l2_bandwidth, "the L2 slices", "l2.sectors_per_cycle");
  carries(best.dram_bandwidth, "DRAM", best.slice_ports, "the slices' reply ports",
          "noc.partition_reply_bytes");
  carries(best.dram_bandwidth, "DRAM", best.core_ports, "the cores' reply ports", "noc.core_reply_bytes");
}

}  // namespace glint::mem
