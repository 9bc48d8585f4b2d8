// Parameters of the memory system: L1, network, L2 and DRAM, with what is impossible and what the peaks are.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "base/diagnostics.h"
#include "base/params.h"
#include "memsys/dram_params.h"

namespace glint::mem {

// Defaults: the mobile part of Vulkan-Sim 2.0 and LumiBench (8 cores, 4 channels), with physical DRAM timing.
struct L1Params {
  uint64_t size = 32 * 1024;     // Vulkan-Sim MOBILE: S:1:128:256
  uint32_t ways = 0;
  uint32_t hit_latency = 20;     // Vulkan-Sim: gpgpu_l1_latency
  uint32_t miss_latency = 20;    // the same: its tags are looked up at the end of the pipeline
  uint32_t ports = 1;            // one 128 B line a cycle, as Volta's L1 delivers
  uint32_t banks = 1;
  uint32_t mshr_entries = 256;   // Vulkan-Sim: A:256:8
  uint32_t mshr_merges = 8;
  uint32_t miss_queue = 16;      // Vulkan-Sim: 16
  bool local_write_back = true;  // Vulkan-Sim: "L", local write-back, global write-through

  static constexpr auto params() {
    return std::tuple{
        param(&L1Params::size, "size", "byte", "Capacity of the data array.", 0, uint64_t{1} << 30),
        param(&L1Params::ways, "ways", "way", "Lines of a set; 0 makes the cache fully associative.", 0, 1 << 20),
        param(&L1Params::hit_latency, "hit_latency", "cycle", "From an access to its token when all sectors are present.", 1, 10000),
        param(&L1Params::miss_latency, "miss_latency", "cycle", "From an access to the earliest departure of its miss.", 0, 10000),
        param(&L1Params::ports, "ports", "access/cycle", "Accesses taken a cycle.", 0, 64),
        param(&L1Params::banks, "banks", "bank", "Banks, chosen by line; each takes one access a cycle.", 0, 64),
        param(&L1Params::mshr_entries, "mshr_entries", "line", "Lines that can be on the way.", 0, 1 << 16),
        param(&L1Params::mshr_merges, "mshr_merges", "request", "Reads that can wait for one line, the first included.", 0, 1 << 12),
        param(&L1Params::miss_queue, "miss_queue", "packet", "Misses, writes and write-backs waiting for the network.", 0, 1 << 16),
        flag(&L1Params::local_write_back, "local_write_back", "Local memory is written back on eviction instead of written through.")};
  }
};

struct NocParams {
  uint32_t core_request_bytes = 40;       // one flit a cycle: Vulkan-Sim icnt_flit_size
  uint32_t core_reply_bytes = 40;
  uint32_t partition_request_bytes = 40;
  uint32_t partition_reply_bytes = 40;
  uint32_t request_latency = 48;          // with the L1 and L2 latencies: L2 hits take 160 cycles (TTA's baseline)
  uint32_t reply_latency = 48;

  static constexpr auto params() {
    return std::tuple{
        param(&NocParams::core_request_bytes, "core_request_bytes", "byte/cycle", "Width of a core's port towards L2.", 0, 4096),
        param(&NocParams::core_reply_bytes, "core_reply_bytes", "byte/cycle", "Width of a core's port from L2.", 0, 4096),
        param(&NocParams::partition_request_bytes, "partition_request_bytes", "byte/cycle", "Width of a partition's port from the cores.", 0, 4096),
        param(&NocParams::partition_reply_bytes, "partition_reply_bytes", "byte/cycle", "Width of a partition's port towards the cores.", 0, 4096),
        param(&NocParams::request_latency, "request_latency", "cycle", "One way, core to partition, without port time.", 0, 10000),
        param(&NocParams::reply_latency, "reply_latency", "cycle", "One way, partition to core, without port time.", 0, 10000)};
  }
};

struct L2Params {
  uint64_t slice_size = 128 * 1024;  // Vulkan-Sim: S:64:128:16 a partition
  uint32_t ways = 16;
  uint32_t latency = 42;             // see NocParams::request_latency
  uint32_t sectors_per_cycle = 2;    // measured on H100: two sectors a clock and slice
  uint32_t mshr_entries = 192;       // Vulkan-Sim: A:192:4
  uint32_t mshr_merges = 4;
  uint32_t dram_queue = 64;          // Vulkan-Sim: dram_partition_queues
  uint32_t atomic_interval = 2;      // Choice: unpublished; an H200 does 1.4 G lane atomics a second on one word

  static constexpr auto params() {
    return std::tuple{
        param(&L2Params::slice_size, "slice_size", "byte", "Capacity of the slice of one partition.", 0, uint64_t{1} << 32),
        param(&L2Params::ways, "ways", "way", "Lines of a set; 0 makes the slice fully associative.", 0, 1 << 20),
        param(&L2Params::latency, "latency", "cycle", "From service to the reply of a hit, or to the miss's way to DRAM.", 1, 10000),
        param(&L2Params::sectors_per_cycle, "sectors_per_cycle", "sector/cycle", "Sectors read or written a cycle.", 0, 64),
        param(&L2Params::mshr_entries, "mshr_entries", "line", "Lines that can be on the way.", 0, 1 << 16),
        param(&L2Params::mshr_merges, "mshr_merges", "request", "Reads that can wait for one line, the first included.", 0, 1 << 12),
        param(&L2Params::dram_queue, "dram_queue", "request", "Sector reads and writes between the slice and the DRAM scheduler.", 0, 1 << 16),
        param(&L2Params::atomic_interval, "atomic_interval", "cycle", "Cycles of the slice for each sector of an atomic.", 1, 1000)};
  }
};

struct Params {
  uint32_t line = 128;        // Volta and later: 4 sectors of 32 B
  uint32_t interleave = 256;  // GPGPU-Sim: dramid@8
  L1Params l1;
  NocParams noc;
  L2Params l2;
  DramParams dram;

  static constexpr auto params() {
    return std::tuple{param(&Params::line, "line", "byte", "Line of both cache levels.", 0, 4096),
                      param(&Params::interleave, "interleave", "byte", "Consecutive bytes that stay in one partition.", 0, 1 << 20),
                      section(&Params::l1, "l1", "Data cache of each core."),
                      section(&Params::noc, "noc", "Network between cores and partitions."),
                      section(&Params::l2, "l2", "Cache slice of each partition."),
                      section(&Params::dram, "dram", "Memory channel of each partition.")};
  }
};

// Reports every impossible combination with what was expected. Call before building a MemorySystem.
// `section` ("memory.") stands before each key in the messages.
void check(const Params& params, Diagnostics& diagnostics, const std::string& section = {});

// What the machine could do at best, to hold against a data sheet.
struct Peak {
  uint64_t l2_bytes = 0;             // capacity over all slices
  double l1_bytes_per_second = 0;    // data of all cores' L1 hits
  double noc_bytes_per_second = 0;   // reply data into cores or out of partitions, whichever is narrower
  double l2_bytes_per_second = 0;    // data of all slices
  double dram_bytes_per_second = 0;  // all data buses
  std::string to_string() const;     // one line
};
Peak peak(const Params& params, uint32_t num_cores, double core_mhz);

}  // namespace glint::mem
