// Parameters of the memory system: L1, network, L2 and DRAM, with what is impossible and what the peaks are.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "base/diagnostics.h"
#include "base/params.h"
#include "base/registry.h"
#include "memsys/dram/dram_params.h"
#include "memsys/network.h"
#include "memsys/replacement.h"

namespace glint::mem {

// Defaults: the mobile part of Vulkan-Sim 2.0 and LumiBench (8 cores, 4 channels), with physical DRAM timing.
std::vector<std::string> l1_allocations();    // on_fill, on_miss
std::vector<std::string> partition_hashes();  // mixed, none

struct L1Params {
  uint64_t size = 32 * 1024;  // Vulkan-Sim MOBILE: S:1:128:256
  uint32_t ways = 0;
  PolicyChoice<Replacement> replacement{"lru"};  // Vulkan-Sim: "L"
  uint32_t hit_latency = 20;                     // Vulkan-Sim: gpgpu_l1_latency
  uint32_t miss_latency = 20;  // the same: its tags are looked up at the end of the pipeline
  uint32_t ports = 1;          // one 128 B line a cycle, as Volta's L1 delivers
  uint32_t banks = 1;
  uint32_t mshr_entries = 256;  // Vulkan-Sim: A:256:8
  uint32_t mshr_merges = 8;
  uint32_t miss_queue = 16;      // Vulkan-Sim: 16
  bool local_write_back = true;  // Vulkan-Sim: "L", local write-back, global write-through
  bool global_write_back = false;
  bool write_allocate = false;       // Vulkan-Sim: "N"; Accel-Sim's newer parts allocate
  bool write_evict = false;          // GPGPU-Sim's global stores: what they hit is dropped
  std::string allocate = "on_fill";  // Vulkan-Sim: "s", streaming
  bool fill_takes_access = true;     // Choice: arrays of one port; unpublished

  static constexpr auto params() {
    return std::tuple{
        param(&L1Params::size, "size", "byte", "Capacity of the data array.", 0, uint64_t{1} << 30),
        param(&L1Params::ways, "ways", "way", "Lines of a set; 0 makes the cache fully associative.", 0,
              1 << 20),
        policy(&L1Params::replacement, "replacement", "Which line of a set makes way for a new line."),
        param(&L1Params::hit_latency, "hit_latency", "cycle",
              "From an access to its token when all sectors are present.", 0, 10000),
        param(&L1Params::miss_latency, "miss_latency", "cycle",
              "From an access to the earliest departure of its miss.", 0, 10000),
        param(&L1Params::ports, "ports", "access/cycle", "Accesses taken a cycle.", 0, 64),
        param(&L1Params::banks, "banks", "bank", "Banks, chosen by line; each takes one access a cycle.", 0,
              64),
        param(&L1Params::mshr_entries, "mshr_entries", "line", "Lines that can be on the way.", 0, 1 << 16),
        param(&L1Params::mshr_merges, "mshr_merges", "request",
              "Reads that can wait for one line, the first included.", 0, 1 << 12),
        param(&L1Params::miss_queue, "miss_queue", "packet",
              "Misses, writes and write-backs waiting for the network.", 0, 1 << 16),
        flag(&L1Params::local_write_back, "local_write_back",
             "Local memory is written back on eviction instead of written through."),
        flag(&L1Params::global_write_back, "global_write_back",
             "All other memory is written back on eviction as well."),
        flag(&L1Params::write_allocate, "write_allocate",
             "A write that is written through keeps its whole sectors in a line; otherwise it allocates "
             "none."),
        flag(&L1Params::write_evict, "write_evict",
             "A write that is written through drops the sectors that it hits; otherwise they get the new "
             "bytes."),
        choice(&L1Params::allocate, "allocate",
               "When a miss takes its line: with the data (streaming), or already when it leaves, held until "
               "then.",
               &l1_allocations),
        flag(&L1Params::fill_takes_access, "fill_takes_access",
             "A fill keeps its bank from taking an access in the same cycle.")};
  }
};

struct NocParams {
  PolicyChoice<Network> topology{"crossbar"};  // Choice: unpublished
  uint32_t core_request_bytes = 40;            // one flit a cycle: Vulkan-Sim icnt_flit_size
  uint32_t core_reply_bytes = 40;
  uint32_t partition_request_bytes = 40;
  uint32_t partition_reply_bytes = 40;
  uint32_t request_latency = 48;  // with the L1 and L2 latencies: L2 hits take 160 cycles (TTA's baseline)
  uint32_t reply_latency = 48;
  uint32_t credits = 16;  // Choice: a core's L1 can send no more than its miss queue; unpublished
  uint32_t sides = 1;     // H100: 2, of which the far one costs 156 cycles more there and back
  uint32_t far_latency = 0;

  static constexpr auto params() {
    return std::tuple{
        policy(&NocParams::topology, "topology", "How cores and slices are connected."),
        param(&NocParams::core_request_bytes, "core_request_bytes", "byte/cycle",
              "Width of a core's port towards L2.", 0, 4096),
        param(&NocParams::core_reply_bytes, "core_reply_bytes", "byte/cycle",
              "Width of a core's port from L2.", 0, 4096),
        param(&NocParams::partition_request_bytes, "partition_request_bytes", "byte/cycle",
              "Width of a partition's port from the cores.", 0, 4096),
        param(&NocParams::partition_reply_bytes, "partition_reply_bytes", "byte/cycle",
              "Width of a partition's port towards the cores.", 0, 4096),
        param(&NocParams::request_latency, "request_latency", "cycle",
              "One way, core to partition, without port time.", 0, 10000),
        param(&NocParams::reply_latency, "reply_latency", "cycle",
              "One way, partition to core, without port time.", 0, 10000),
        param(&NocParams::credits, "credits", "packet",
              "Packets of one core that may be on their way to one L2 slice or wait there; 0 is no limit.", 0,
              1 << 12),
        param(&NocParams::sides, "sides", "side",
              "Parts of the chip that cores and slices are split into evenly, in order.", 1, 16),
        param(&NocParams::far_latency, "far_latency", "cycle",
              "One way between two sides, beyond the latency within one.", 0, 10000)};
  }
};

struct L2Params {
  uint32_t slices = 1;               // Vulkan-Sim MOBILE: one sub-partition
  uint64_t slice_size = 128 * 1024;  // Vulkan-Sim: S:64:128:16 a partition
  uint32_t ways = 16;
  PolicyChoice<Replacement> replacement{"lru"};  // Vulkan-Sim: "L"
  uint32_t latency = 42;                         // see NocParams::request_latency
  uint32_t sectors_per_cycle = 2;                // measured on H100: two sectors a clock and slice
  uint32_t mshr_entries = 192;                   // Vulkan-Sim: A:192:4
  uint32_t mshr_merges = 4;
  uint32_t dram_queue = 64;      // Vulkan-Sim: dram_partition_queues
  uint32_t atomic_interval = 2;  // Choice: unpublished; an H200: 2, and an eighth a lane (docs/validation.md)
  double atomic_lane_interval = 0;
  double write_visit =
      0;  // an H200: 1.25, beside a cycle a whole sector and 1.31 one in part (docs/validation.md)
  double partial_interval = 0;
  bool write_masks = true;         // GPGPU-Sim: byte masks, a sector is fetched when it is read
  bool fill_takes_service = true;  // Choice: arrays of one port; unpublished

  static constexpr auto params() {
    return std::tuple{
        param(&L2Params::slices, "slices", "slice",
              "Slices of a partition, each with ports of its own, in front of its DRAM channel.", 1, 16),
        param(&L2Params::slice_size, "slice_size", "byte", "Capacity of one slice.", 0, uint64_t{1} << 32),
        param(&L2Params::ways, "ways", "way", "Lines of a set; 0 makes the slice fully associative.", 0,
              1 << 20),
        policy(&L2Params::replacement, "replacement", "Which line of a set makes way for a new line."),
        param(&L2Params::latency, "latency", "cycle",
              "From service to the reply of a hit, or to the miss's way to DRAM.", 1, 10000),
        param(&L2Params::sectors_per_cycle, "sectors_per_cycle", "sector/cycle",
              "Sectors read or written a cycle.", 0, 64),
        param(&L2Params::mshr_entries, "mshr_entries", "line", "Lines that can be on the way.", 0, 1 << 16),
        param(&L2Params::mshr_merges, "mshr_merges", "request",
              "Reads that can wait for one line, the first included.", 0, 1 << 12),
        param(&L2Params::dram_queue, "dram_queue", "request",
              "Sector reads and writes between the slice and the DRAM scheduler.", 0, 1 << 16),
        param(&L2Params::atomic_interval, "atomic_interval", "cycle",
              "Cycles of the slice for each sector of an atomic, and for each turn at it where lanes take "
              "turns.",
              1, 1000),
        param(&L2Params::atomic_lane_interval, "atomic_lane_interval", "cycle",
              "Cycles of the slice for each lane of an atomic beside, to a sixteenth.", 0.0, 1000.0),
        param(&L2Params::write_visit, "write_visit", "cycle",
              "Cycles of the slice for each write, beside its sectors', which then take a cycle each; 0: "
              "none, and sectors as read.",
              0.0, 1000.0),
        param(&L2Params::partial_interval, "partial_interval", "cycle",
              "Cycles of the slice for each sector that a write covers in part, to a sixteenth; 0: those of "
              "a whole one.",
              0.0, 1000.0),
        flag(&L2Params::write_masks, "write_masks",
             "A sector of which a part is written is fetched when it is read; otherwise each write covers "
             "its sectors."),
        flag(&L2Params::fill_takes_service, "fill_takes_service",
             "Sectors from DRAM take the slice's time as sectors read do.")};
  }
};

struct Params {
  uint32_t line = 128;        // Volta and later: 4 sectors of 32 B
  uint32_t interleave = 256;  // GPGPU-Sim: dramid@8
  std::string hash = "mixed";
  L1Params l1;
  NocParams noc;
  L2Params l2;
  DramParams dram;

  static constexpr auto params() {
    return std::tuple{
        param(&Params::line, "line", "byte", "Line of both cache levels.", 0, 4096),
        param(&Params::interleave, "interleave", "byte", "Consecutive bytes that stay in one partition.", 0,
              1 << 20),
        choice(&Params::hash, "hash",
               "How addresses spread over slices: each round of them turned by a hash, or one after another.",
               &partition_hashes),
        section(&Params::l1, "l1", "Data cache of each core."),
        section(&Params::noc, "noc", "Network between cores and partitions."),
        section(&Params::l2, "l2", "Cache slice of each partition."),
        section(&Params::dram, "dram", "Memory channel of each partition.")};
  }
  uint32_t num_slices() const { return dram.channels * l2.slices; }
};

// Reports every impossible combination with what was expected. Call before building a MemorySystem.
// `section` ("memory.") stands before each key in the messages.
void check(const Params& params, Diagnostics& diagnostics, const std::string& section = {});

}  // namespace glint::mem
