// What a memory configuration could deliver at best, to compare with a data sheet, and which of its levels
// cannot carry what another delivers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "base/diagnostics.h"
#include "memsys/params.h"

namespace glint::mem {

// Bandwidths are bytes of data a second, without headers.
struct Peak {
  uint64_t l1_bytes = 0, l2_bytes = 0;  // capacities over all cores and slices
  double l1_bandwidth = 0;              // data of all cores' L1 hits
  double core_ports = 0;                // replies into all cores
  double slice_ports = 0;               // replies out of all slices
  double l2_bandwidth = 0;              // data of all slices
  double dram_bandwidth = 0;            // all data buses
  double dram_refreshed = 0;            // the same without the time of refresh
  double network() const { return core_ports < slice_ports ? core_ports : slice_ports; }
  std::string to_string() const;  // one line
};
Peak peak(const Params& params, uint32_t num_cores, double core_mhz);

// Warns where one level could deliver more than the next can carry. `params` must have passed check().
void warn(const Params& params, uint32_t num_cores, double core_mhz, Diagnostics& diagnostics,
          const std::string& section = {});

}  // namespace glint::mem
