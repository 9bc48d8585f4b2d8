// What a memory configuration could do at best, to hold against a data sheet, and where its levels do not fit
// each other.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "base/diagnostics.h"
#include "memsys/params.h"

namespace glint::mem {

// Bytes of data, without headers, a second; every reply of one sector.
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

// Warns of what one level could deliver and the next not carry. `params` must have passed check().
void warn(const Params& params, uint32_t num_cores, double core_mhz, Diagnostics& diagnostics,
          const std::string& section = {});

}  // namespace glint::mem
