// Declares the parameters of the memory system (L1, network, L2 and DRAM), and the check that finds
// impossible ones.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/params.h"
#include "base/registry.h"
#include "memsys/dram/dram_params.h"
#include "memsys/network.h"
#include "memsys/replacement.h"

namespace glint::mem {

// The defaults are the mobile part of Vulkan-Sim 2.0 and LumiBench (8 cores, 4 channels), with physical DRAM
// timing.
std::vector<std::string> l1_allocations();    // returns on_fill and on_miss
std::vector<std::string> partition_hashes();  // returns mixed, classes and none

struct L1Params {
  uint64_t size = 32 * 1024;  // Vulkan-Sim MOBILE: S:1:128:256
  uint32_t ways = 0;
  PolicyChoice<Replacement> replacement{"lru"};  // Vulkan-Sim: "L"
  uint32_t hit_latency = 20;                     // Vulkan-Sim: gpgpu_l1_latency
  uint32_t miss_latency = 20;                    // as hit_latency; tags are looked up at the pipeline's end
  uint32_t ports = 1;                            // Volta's L1 delivers one line of 128 bytes per cycle
  uint32_t banks = 1;
  uint32_t mshr_entries = 256;  // Vulkan-Sim: A:256:8
  uint32_t mshr_merges = 8;
  uint32_t miss_queue = 16;      // Vulkan-Sim: 16
  bool local_write_back = true;  // Vulkan-Sim: "L", which writes local memory back and global through
  bool global_write_back = false;
  bool write_allocate = false;       // Vulkan-Sim: "N"; Accel-Sim's newer parts allocate
  bool write_evict = false;          // GPGPU-Sim's global stores drop what they hit
  std::string allocate = "on_fill";  // Vulkan-Sim: "s", streaming
  bool fill_takes_access = true;     // Choice: arrays have one port; vendors do not publish it

  static ParamList params() {
    return {
        param(&L1Params::size, "size", "byte", "Size of the L1's data array.", 0, uint64_t{1} << 30),
        param(&L1Params::ways, "ways", "way", "Number of lines per set. 0: the cache is fully associative.",
              0, 1 << 20),
        policy(&L1Params::replacement, "replacement",
               "Selects the line of a set that makes way for a new line in the L1."),
        param(&L1Params::hit_latency, "hit_latency", "cycle",
              "Cycles from an access to its answer when all sectors are present.", 0, 10000),
        param(&L1Params::miss_latency, "miss_latency", "cycle",
              "Cycles from an access to the earliest departure of its miss.", 0, 10000),
        param(&L1Params::ports, "ports", "access/cycle",
              "Largest number of accesses that the cache takes per cycle.", 0, 64),
        param(&L1Params::banks, "banks", "bank",
              "Number of banks. Lines are spread over them, and each bank takes one access per cycle.", 0,
              64),
        param(&L1Params::mshr_entries, "mshr_entries", "line",
              "Largest number of lines that are on their way to the cache at once.", 0, 1 << 16),
        param(&L1Params::mshr_merges, "mshr_merges", "request",
              "Largest number of reads that wait for one line on its way, the first included.", 0, 1 << 12),
        param(&L1Params::miss_queue, "miss_queue", "packet",
              "Largest number of misses, writes and write-backs that wait for the network.", 0, 1 << 16),
        flag(&L1Params::local_write_back, "local_write_back",
             "True: a write to local memory stays in the cache until its line is evicted. False: it goes "
             "through to the L2."),
        flag(&L1Params::global_write_back, "global_write_back",
             "True: a write to memory other than local memory stays in the cache until its line is evicted. "
             "False: it goes through to the L2."),
        flag(&L1Params::write_allocate, "write_allocate",
             "True: a write that goes through to the L2 allocates a line with the sectors that it covers "
             "whole. False: it allocates none."),
        flag(&L1Params::write_evict, "write_evict",
             "True: a write that goes through to the L2 drops the sectors that it hits. False: they get the "
             "new bytes."),
        choice(&L1Params::allocate, "allocate",
               "Selects when a miss takes its line: when the data arrive (streaming), or when the miss is "
               "accepted, which holds the line until the data arrive.",
               &l1_allocations),
        flag(&L1Params::fill_takes_access, "fill_takes_access",
             "True: a fill keeps its bank from taking an access in the same cycle. False: it does not.")};
  }
};

struct NocParams {
  PolicyChoice<Network> topology{"crossbar"};  // Choice: vendors do not publish it
  uint32_t core_request_bytes = 40;            // Vulkan-Sim: icnt_flit_size, one flit per cycle
  uint32_t core_reply_bytes = 40;
  uint32_t partition_request_bytes = 40;
  uint32_t partition_reply_bytes = 40;
  // With the latencies of L1 and L2, an L2 hit takes 160 cycles (TTA's baseline).
  uint32_t request_latency = 48;
  uint32_t reply_latency = 48;
  uint32_t credits = 16;  // Choice: as many as an L1's miss queue has entries; vendors do not publish it
  uint32_t sides = 1;     // an H100 has 2; the far side takes 156 cycles more, there and back
  uint32_t far_latency = 0;

  static ParamList params() {
    return {
        policy(&NocParams::topology, "topology",
               "Selects the network that connects the cores with the L2 slices."),
        param(&NocParams::core_request_bytes, "core_request_bytes", "byte/cycle",
              "Width of a core's port towards the network.", 0, 4096),
        param(&NocParams::core_reply_bytes, "core_reply_bytes", "byte/cycle",
              "Width of a core's port from the network.", 0, 4096),
        param(&NocParams::partition_request_bytes, "partition_request_bytes", "byte/cycle",
              "Width of an L2 slice's port from the network.", 0, 4096),
        param(&NocParams::partition_reply_bytes, "partition_reply_bytes", "byte/cycle",
              "Width of an L2 slice's port towards the network.", 0, 4096),
        param(&NocParams::request_latency, "request_latency", "cycle",
              "Cycles from a core's port to an L2 slice's port through the crossbar, without the time in "
              "ports.",
              0, 10000),
        param(&NocParams::reply_latency, "reply_latency", "cycle",
              "Cycles from an L2 slice's port to a core's port through the crossbar, without the time in "
              "ports.",
              0, 10000),
        param(&NocParams::credits, "credits", "packet",
              "Largest number of packets of one core that are on their way through the crossbar to one L2 "
              "slice, or wait there. 0: there is no limit.",
              0, 1 << 12),
        param(&NocParams::sides, "sides", "side",
              "Number of sides of the chip that the crossbar spans. Cores and L2 slices are split evenly, in "
              "order.",
              1, 16),
        param(&NocParams::far_latency, "far_latency", "cycle",
              "Extra cycles of one way through the crossbar between two sides of the chip.", 0, 10000)};
  }
};

struct L2Params {
  uint32_t slices = 1;               // Vulkan-Sim MOBILE: one sub-partition
  uint64_t slice_size = 128 * 1024;  // Vulkan-Sim: S:64:128:16 for a partition
  uint32_t ways = 16;
  PolicyChoice<Replacement> replacement{"lru"};  // Vulkan-Sim: "L"
  uint32_t latency = 42;                         // see NocParams::request_latency
  uint32_t sectors_per_cycle = 2;                // measured on H100: two sectors per clock and slice
  uint32_t mshr_entries = 192;                   // Vulkan-Sim: A:192:4
  uint32_t mshr_merges = 4;
  uint32_t dram_queue = 64;                  // Vulkan-Sim: dram_partition_queues
  double read_interval = 0, read_visit = 0;  // H200: 0.625 and 1.125 (docs/validation.md)
  // Choice: vendors do not publish the interval. An H200 takes 1.46 cycles, and 0.3 for another line
  // (docs/validation.md).
  double atomic_interval = 2, atomic_visit = 0;
  double atomic_whole_interval = 0, atomic_float_interval = 0, atomic_lane_interval = 0,
         atomic_answer_interval = 0;
  // A write takes 1.25 cycles on an H200, with one more for each whole sector and 1.31 for each sector that
  // is written in part (docs/validation.md).
  double write_visit = 0;
  double partial_interval = 0;
  bool write_masks = true;         // GPGPU-Sim has byte masks and fetches a sector when it is read
  bool fill_takes_service = true;  // Choice: arrays have one port; vendors do not publish it

  static ParamList params() {
    ParamList rows = {
        param(&L2Params::slices, "slices", "slice",
              "Number of L2 slices in a partition. Each slice has its own ports, and all share the DRAM "
              "channel.",
              1, 16),
        param(&L2Params::slice_size, "slice_size", "byte", "Size of an L2 slice.", 0, uint64_t{1} << 32),
        param(&L2Params::ways, "ways", "way", "Number of lines per set. 0: the slice is fully associative.",
              0, 1 << 20),
        policy(&L2Params::replacement, "replacement",
               "Selects the line of a set that makes way for a new line in an L2 slice."),
        param(&L2Params::latency, "latency", "cycle",
              "Cycles from the service of a packet to the reply of a hit, or to the departure of a miss to "
              "DRAM.",
              1, 10000),
        param(&L2Params::sectors_per_cycle, "sectors_per_cycle", "sector/cycle",
              "Number of sectors that a slice reads or writes per cycle.", 0, 64),
        param(&L2Params::read_interval, "read_interval", "cycle",
              "Slice cycles per sector of a read, in steps of 1/16. 0: `sectors_per_cycle` tells them.", 0.0,
              1000.0),
        param(&L2Params::read_visit, "read_visit", "cycle",
              "Fewest slice cycles per read, in steps of 1/16, when `read_interval` is not 0.", 0.0, 1000.0),
        param(&L2Params::mshr_entries, "mshr_entries", "line",
              "Largest number of lines that are on their way to the slice at once.", 0, 1 << 16),
        param(&L2Params::mshr_merges, "mshr_merges", "request",
              "Largest number of reads that wait for one line on its way, the first included.", 0, 1 << 12),
        param(&L2Params::dram_queue, "dram_queue", "request",
              "Largest number of reads and writes of sectors that wait between the slice and the DRAM "
              "scheduler.",
              0, 1 << 16)};
    for (ParamRow& row : service_params()) rows.push_back(std::move(row));
    return rows;
  }

 private:
  // Returns the parameters of what atomics, writes and fills take of a slice's time.
  static ParamList service_params() {
    return {
        param(&L2Params::atomic_interval, "atomic_interval", "cycle",
              "Slice cycles per sector of an atomic, or per turn at the sector where lanes take turns, in "
              "steps of 1/16.",
              1.0, 1000.0),
        param(&L2Params::atomic_visit, "atomic_visit", "cycle",
              "Extra slice cycles per atomic at another line than the slice's atomic before it, in steps of "
              "1/16.",
              0.0, 1000.0),
        param(&L2Params::atomic_whole_interval, "atomic_whole_interval", "cycle",
              "Slice cycles per turn of an atomic whose turns all have eight words of a sector, in steps of "
              "1/16. 0: these are as long as others.",
              0.0, 1000.0),
        param(&L2Params::atomic_float_interval, "atomic_float_interval", "cycle",
              "Slice cycles per turn of an addition of single or double precision, in steps of 1/16. 0: they "
              "are those of other atomics.",
              0.0, 1000.0),
        param(&L2Params::atomic_lane_interval, "atomic_lane_interval", "cycle",
              "Extra slice cycles per lane of an atomic, in steps of 1/16.", 0.0, 1000.0),
        param(&L2Params::atomic_answer_interval, "atomic_answer_interval", "cycle",
              "Extra slice cycles per lane of an atomic that returns the old value and is at another line "
              "than the "
              "slice's atomic before it, in steps of 1/16.",
              0.0, 1000.0),
        param(&L2Params::write_visit, "write_visit", "cycle",
              "Fixed slice cycles per write, plus one cycle per sector. 0: there is no fixed cost, and "
              "sectors cost the same as for reads.",
              0.0, 1000.0),
        param(&L2Params::partial_interval, "partial_interval", "cycle",
              "Slice cycles per sector that a write covers in part, in steps of 1/16. 0: they are the same "
              "as for a whole sector.",
              0.0, 1000.0),
        flag(&L2Params::write_masks, "write_masks",
             "True: the slice knows which words of a sector were written, and fetches a sector that was "
             "written in part when it is read. False: each write covers its sectors whole."),
        flag(&L2Params::fill_takes_service, "fill_takes_service",
             "True: sectors from DRAM take the slice's time, as sectors that are read do. False: they take "
             "none.")};
  }
};

struct Params {
  uint32_t line = 128;        // Volta and later have 4 sectors of 32 bytes
  uint32_t interleave = 256;  // GPGPU-Sim: dramid@8
  std::string hash = "mixed";
  L1Params l1;
  NocParams noc;
  L2Params l2;
  DramParams dram;

  static ParamList params() {
    return {
        param(&Params::line, "line", "byte", "Size of a line in both cache levels.", 0, 4096),
        param(&Params::interleave, "interleave", "byte",
              "Number of consecutive bytes that stay in one partition.", 0, 1 << 20),
        choice(&Params::hash, "hash",
               "Selects how chunks of `interleave` bytes spread over the L2 slices: a hash rotates the order "
               "of the slices in each round, units of 64 chunks take 32 slices of a half each as on GPUs "
               "with 80 and 96 slices, or every round has the same order.",
               &partition_hashes),
        section(&Params::l1, "l1", "Parameters of the data cache of each core (L1)."),
        section(&Params::noc, "noc", "Parameters of the network between cores and L2 slices."),
        section(&Params::l2, "l2", "Parameters of the L2 slices of each partition."),
        section(&Params::dram, "dram", "Parameters of the DRAM channel of each partition.")};
  }
  uint32_t num_slices() const { return dram.channels * l2.slices; }
};

// Reports every impossible combination with what was expected. It is called before a MemorySystem is built.
// `section` ("memory.") stands in front of each key in the messages.
void check(const Params& params, Diagnostics& diagnostics, const std::string& section = {});

}  // namespace glint::mem
