// Parameters of a memory channel: geometry, clocks and times in nanoseconds, and the named sets of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/params.h"
#include "base/registry.h"
#include "memsys/dram_model.h"
#include "memsys/dram_scheduler.h"

namespace glint::mem {

std::vector<std::string> dram_kinds();  // names, in the order of the table
std::string_view dram_kind_doc(std::string_view name);
void apply_dram_kind(DramParams& params,
                     std::string_view name);  // sets all that a data sheet says of one channel
std::vector<std::string> refresh_modes();

// Choice: a kind is read before all other keys, whatever their order in the file, so that single keys change
// it.
struct DramKindParam {
  std::string_view name, doc;
};
void read_param(ConfigTable& table, DramParams& out, const DramKindParam& param);
void describe_param(std::vector<ParamInfo>& out, const std::string& prefix, const DramParams& params,
                    const DramKindParam& param);

// Times in nanoseconds: a data sheet's numbers, rounded up to command clocks as JEDEC standards ask. The
// defaults are the kind gddr6_7000.
struct DramParams {
  std::string kind = "gddr6_7000";
  uint32_t channels = 4;
  PolicyChoice<DramModel> model{"banked"};
  uint32_t bank_groups = 4;
  uint32_t banks = 16;
  uint32_t row_bytes = 2048;
  uint32_t bus_bytes = 2;
  double clock_mhz = 1750.0;         // GDDR6 command clock, tCK 570 ps (Ramulator 2.1 GDDR6-14000)
  uint32_t transfers_per_clock = 4;  // 7 GT/s on 2 bytes: 14 GB/s a channel, 56 GB/s on 4 (Vulkan-Sim MOBILE)
  uint32_t burst = 16;               // GDDR6: 16n prefetch, 32 B an access
  uint32_t queue = 64;               // Vulkan-Sim: frfcfs_dram_sched_queue_size
  uint32_t latency = 100;            // Vulkan-Sim: dram_latency, core cycles
  bool dual_command_bus = false;
  uint32_t activate_clocks = 1;
  uint32_t bus_turn = 2;  // GPGPU-Sim: tRTW = CL + BL + 2 - WL
  PolicyChoice<DramScheduler> scheduler{"frfcfs"};
  // Ramulator 2.1, GDDR6-14000 at 1.35 V, clocks of 0.57 ns turned into times.
  double rcd = 15.4, rcd_write = 9.2, rp = 15.4, ras = 30.2, rc = 45.0;
  double cl = 13.7, wl = 3.4, wr = 15.4, rtp = 2.28;
  double ccd_s = 1.14, ccd_l = 2.28, rrd_s = 4.56, rrd_l = 4.56, faw = 16.5;
  double wtr_s = 5.13, wtr_l = 6.27;
  std::string refresh = "all_bank";
  double refi = 1900.0, rfc = 120.3, rfc_bank = 60.4;

  static constexpr auto params() {
    return std::tuple{
        DramKindParam{"kind",
                      "A part of this name sets the keys below up to `rfc_bank`, but `channels`, `queue`, "
                      "`latency` and policies; keys that are given win."},
        param(&DramParams::channels, "channels", "channel",
              "Memory partitions, each one DRAM channel and its L2 slices.", 0, 1024),
        policy(&DramParams::model, "model",
               "How long the channel takes: commands of banks, or one latency and one bandwidth."),
        param(&DramParams::bank_groups, "bank_groups", "group", "Bank groups of a channel.", 0, 64),
        param(&DramParams::banks, "banks", "bank", "Banks of a channel, over all groups.", 0, 64),
        param(&DramParams::row_bytes, "row_bytes", "byte", "Bytes of a row of one bank.", 0, 1 << 20),
        param(&DramParams::bus_bytes, "bus_bytes", "byte", "Width of a channel's data bus.", 0, 1024),
        param(&DramParams::clock_mhz, "clock_mhz", "MHz", "Command clock.", 1.0, 100000.0),
        param(&DramParams::transfers_per_clock, "transfers_per_clock", "transfer/clock",
              "Data transfers a command clock.", 0, 64),
        param(&DramParams::burst, "burst", "transfer", "Transfers of one column command.", 0, 256),
        param(&DramParams::queue, "queue", "request", "Requests the scheduler chooses from.", 0, 1 << 16),
        param(&DramParams::latency, "latency", "core cycle", "From the L2 slice to the scheduler's queue.", 0,
              10000),
        flag(&DramParams::dual_command_bus, "dual_command_bus",
             "One row and one column command a clock, as HBM; otherwise one command a clock."),
        param(&DramParams::activate_clocks, "activate_clocks", "clock",
              "Clocks of the command bus for an activate.", 1, 8),
        param(&DramParams::bus_turn, "bus_turn", "clock",
              "Clocks of the data bus between a read's data and a write's.", 0, 1000),
        policy(&DramParams::scheduler, "scheduler", "Which waiting request a free bank gets."),
        param(&DramParams::rcd, "rcd", "ns", "Activate to read.", 0.0, 10000.0),
        param(&DramParams::rcd_write, "rcd_write", "ns", "Activate to write.", 0.0, 10000.0),
        param(&DramParams::rp, "rp", "ns", "Precharge to activate.", 0.0, 10000.0),
        param(&DramParams::ras, "ras", "ns", "Activate to precharge.", 0.0, 10000.0),
        param(&DramParams::rc, "rc", "ns", "Activate to activate of one bank.", 0.0, 10000.0),
        param(&DramParams::cl, "cl", "ns", "Read command to its first data.", 0.0, 10000.0),
        param(&DramParams::wl, "wl", "ns", "Write command to its first data.", 0.0, 10000.0),
        param(&DramParams::wr, "wr", "ns", "Last write data to precharge.", 0.0, 10000.0),
        param(&DramParams::rtp, "rtp", "ns", "Read command to precharge.", 0.0, 10000.0),
        param(&DramParams::ccd_s, "ccd_s", "ns", "Column command to column command, other bank group.", 0.0,
              10000.0),
        param(&DramParams::ccd_l, "ccd_l", "ns", "Column command to column command, same bank group.", 0.0,
              10000.0),
        param(&DramParams::rrd_s, "rrd_s", "ns", "Activate to activate, other bank group.", 0.0, 10000.0),
        param(&DramParams::rrd_l, "rrd_l", "ns", "Activate to activate, same bank group.", 0.0, 10000.0),
        param(&DramParams::faw, "faw", "ns", "Window that holds at most four activates.", 0.0, 10000.0),
        param(&DramParams::wtr_s, "wtr_s", "ns", "Last write data to read command, other bank group.", 0.0,
              10000.0),
        param(&DramParams::wtr_l, "wtr_l", "ns", "Last write data to read command, same bank group.", 0.0,
              10000.0),
        choice(&DramParams::refresh, "refresh",
               "Whether rows are refreshed, and all banks at once or one after another.", &refresh_modes),
        param(&DramParams::refi, "refi", "ns",
              "From refresh to refresh of the same rows' turn: of all banks, or of each bank.", 1.0, 1e6),
        param(&DramParams::rfc, "rfc", "ns", "Refresh of all banks to activate.", 0.0, 1e5),
        param(&DramParams::rfc_bank, "rfc_bank", "ns", "Refresh of one bank to its activate.", 0.0, 1e5)};
  }
  uint32_t atom_bytes() const { return bus_bytes * burst; }  // of one column command
};

inline DramModel::DramModel(const Context& context, DramClock data_clocks)
    : clocks_(context.core_mhz, context.params.clock_mhz),
      data_clocks_(data_clocks),
      stats_(context.parent, double(context.params.transfers_per_clock) * context.params.bus_bytes),
      capacity_(context.params.queue) {
}

}  // namespace glint::mem
