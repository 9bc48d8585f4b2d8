// Computes what a memory configuration could deliver at best, to compare with a data sheet, and warns where
// one of its levels cannot carry what another delivers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "base/diagnostics.h"
#include "memsys/params.h"

namespace glint::mem {

// Bandwidths are bytes of data per second, without headers.
struct Peak {
  uint64_t l1_bytes = 0, l2_bytes = 0;  // capacities over all cores and slices
  double l1_bandwidth = 0;              // data of the L1 hits of all cores
  double core_ports = 0;                // data of the replies into all cores
  double slice_ports = 0;               // data of the replies out of all slices
  double l2_bandwidth = 0;              // data that all slices deliver
  double dram_bandwidth = 0;            // data of all DRAM buses
  double dram_refreshed = 0;            // data of all DRAM buses, without the time of refresh
  double network() const { return core_ports < slice_ports ? core_ports : slice_ports; }
  std::string to_string() const;  // returns one line of text
};
Peak peak(const Params& params, uint32_t num_cores, double core_mhz);

// Warns where one level could deliver more than the next can carry. `params` must have passed check().
void warn(const Params& params, uint32_t num_cores, double core_mhz, Diagnostics& diagnostics,
          const std::string& section = {});

}  // namespace glint::mem
