// Declares the parameters of a memory channel (geometry, clocks, and times in nanoseconds) and named sets of
// them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/params.h"
#include "base/registry.h"
#include "memsys/dram_model.h"
#include "memsys/dram_scheduler.h"

namespace glint::mem {

struct DramParams;
std::vector<std::string> dram_kinds();  // returns the names, in the order of their table
std::string_view dram_kind_doc(std::string_view name);
// Sets every parameter that a data sheet gives for one channel.
void apply_dram_kind(DramParams& params, std::string_view name);
std::vector<std::string> refresh_modes();

// Times are a data sheet's nanoseconds. They are rounded up to command clocks, as JEDEC standards ask. The
// defaults are those of the kind gddr6_7000.
struct DramParams {
  std::string kind = "gddr6_7000";
  uint32_t channels = 4;
  PolicyChoice<DramModel> model{"banked"};
  uint32_t bank_groups = 4;
  uint32_t banks = 16;
  uint32_t row_bytes = 2048;
  uint32_t bus_bytes = 2;
  double clock_mhz = 1750.0;  // GDDR6 command clock, tCK 570 ps (Ramulator 2.1 GDDR6-14000)
  // 7 GT/s on 2 bytes give 14 GB/s per channel, and 56 GB/s on 4 channels (Vulkan-Sim MOBILE).
  uint32_t transfers_per_clock = 4;
  uint32_t burst = 16;       // GDDR6 has 16n prefetch, which is 32 bytes per access
  uint32_t queue = 64;       // Vulkan-Sim: frfcfs_dram_sched_queue_size
  uint32_t latency = 100;    // Vulkan-Sim: dram_latency, in core cycles
  uint32_t far_latency = 0;  // an H200: 190; 0, because that of other parts is unpublished
  bool dual_command_bus = false;
  uint32_t activate_clocks = 1;
  uint32_t bus_turn = 2;  // GPGPU-Sim: tRTW = CL + BL + 2 - WL
  PolicyChoice<DramScheduler> scheduler{"frfcfs"};
  // These are the times of GDDR6-14000 at 1.35 V in Ramulator 2.1, with clocks of 0.57 ns as nanoseconds.
  double rcd = 15.4, rcd_write = 9.2, rp = 15.4, ras = 30.2, rc = 45.0;
  double cl = 13.7, wl = 3.4, wr = 15.4, rtp = 2.28;
  double ccd_s = 1.14, ccd_l = 2.28, rrd_s = 4.56, rrd_l = 4.56, faw = 16.5;
  double wtr_s = 5.13, wtr_l = 6.27;
  std::string refresh = "all_bank";
  double refi = 1900.0, rfc = 120.3, rfc_bank = 60.4;

  static ParamList params() {
    ParamList rows = channel_params();
    const ParamList times = time_params();
    rows.insert(rows.end(), times.begin(), times.end());
    return rows;
  }
  // Choice: the kind is read before all other keys, whatever their order in a file, so that a single key can
  // change one number of the kind.
  static ParamList channel_params() {
    return {
        preset<&apply_dram_kind>(
            &DramParams::kind, "kind",
            "Selects the memory part whose data sheet sets the geometry, the clock and the times "
            "of the DRAM channels. A key that a file gives wins over the part.",
            &dram_kinds),
        param(&DramParams::channels, "channels", "channel",
              "Number of memory partitions. Each has one DRAM channel and its L2 slices.", 0, 1024),
        policy(&DramParams::model, "model",
               "Selects how a channel's timing is modelled: by the commands of its banks, or by one latency "
               "and one bandwidth."),
        param(&DramParams::bank_groups, "bank_groups", "group", "Number of bank groups of a channel.", 0, 64),
        param(&DramParams::banks, "banks", "bank", "Number of banks of a channel, over all groups.", 0, 64),
        param(&DramParams::row_bytes, "row_bytes", "byte", "Number of bytes in a row of one bank.", 0,
              1 << 20),
        param(&DramParams::bus_bytes, "bus_bytes", "byte", "Width of a channel's data bus.", 0, 1024),
        param(&DramParams::clock_mhz, "clock_mhz", "MHz", "Frequency of the command clock.", 1.0, 100000.0),
        param(&DramParams::transfers_per_clock, "transfers_per_clock", "transfer/clock",
              "Number of data transfers in a command clock.", 0, 64),
        param(&DramParams::burst, "burst", "transfer", "Number of transfers of one column command.", 0, 256),
        param(&DramParams::queue, "queue", "request",
              "Largest number of requests that the scheduler can choose from.", 0, 1 << 16),
        param(&DramParams::latency, "latency", "core cycle",
              "Cycles from the L2 slice to the scheduler's queue.", 0, 10000),
        param(&DramParams::far_latency, "far_latency", "core cycle",
              "Extra cycles from the L2 slice to the scheduler's queue in every second partition, which "
              "stands for the half of the chip that is far from a core.",
              0, 10000),
        flag(&DramParams::dual_command_bus, "dual_command_bus",
             "True: a clock can carry one row and one column command, as in HBM. False: a clock carries one "
             "command."),
        param(&DramParams::activate_clocks, "activate_clocks", "clock",
              "Number of clocks of the command bus that an activate takes.", 1, 8),
        param(&DramParams::bus_turn, "bus_turn", "clock",
              "Clocks of the data bus from a read's data to a write's data.", 0, 1000),
        policy(&DramParams::scheduler, "scheduler", "Selects which waiting request a free bank gets.")};
  }
  static ParamList time_params() {
    return {
        param(&DramParams::rcd, "rcd", "ns", "Time from activate to read (tRCD).", 0.0, 10000.0),
        param(&DramParams::rcd_write, "rcd_write", "ns", "Time from activate to write (tRCDWR).", 0.0,
              10000.0),
        param(&DramParams::rp, "rp", "ns", "Time from precharge to activate (tRP).", 0.0, 10000.0),
        param(&DramParams::ras, "ras", "ns", "Time from activate to precharge (tRAS).", 0.0, 10000.0),
        param(&DramParams::rc, "rc", "ns", "Time from activate to activate of one bank (tRC).", 0.0, 10000.0),
        param(&DramParams::cl, "cl", "ns", "Time from a read command to its first data (CL).", 0.0, 10000.0),
        param(&DramParams::wl, "wl", "ns", "Time from a write command to its first data (WL).", 0.0, 10000.0),
        param(&DramParams::wr, "wr", "ns", "Time from the last data of a write to precharge (tWR).", 0.0,
              10000.0),
        param(&DramParams::rtp, "rtp", "ns", "Time from a read command to precharge (tRTP).", 0.0, 10000.0),
        param(&DramParams::ccd_s, "ccd_s", "ns",
              "Time from column command to column command in another bank group (tCCD_S).", 0.0, 10000.0),
        param(&DramParams::ccd_l, "ccd_l", "ns",
              "Time from column command to column command in the same bank group (tCCD_L).", 0.0, 10000.0),
        param(&DramParams::rrd_s, "rrd_s", "ns",
              "Time from activate to activate in another bank group (tRRD_S).", 0.0, 10000.0),
        param(&DramParams::rrd_l, "rrd_l", "ns",
              "Time from activate to activate in the same bank group (tRRD_L).", 0.0, 10000.0),
        param(&DramParams::faw, "faw", "ns", "Length of a window that holds at most four activates (tFAW).",
              0.0, 10000.0),
        param(&DramParams::wtr_s, "wtr_s", "ns",
              "Time from the last data of a write to a read command in another bank group (tWTR_S).", 0.0,
              10000.0),
        param(&DramParams::wtr_l, "wtr_l", "ns",
              "Time from the last data of a write to a read command in the same bank group (tWTR_L).", 0.0,
              10000.0),
        choice(
            &DramParams::refresh, "refresh",
            "Selects how rows are refreshed: not at all, in all banks at once, or in one bank after another.",
            &refresh_modes),
        param(&DramParams::refi, "refi", "ns",
              "Time from a refresh of all banks, or of one bank, to its next refresh (tREFI).", 1.0, 1e6),
        param(&DramParams::rfc, "rfc", "ns", "Time from a refresh of all banks to an activate (tRFC).", 0.0,
              1e5),
        param(&DramParams::rfc_bank, "rfc_bank", "ns",
              "Time from a refresh of one bank to an activate of that bank (tRFCpb).", 0.0, 1e5)};
  }
  uint32_t atom_bytes() const { return bus_bytes * burst; }  // returns the bytes of one column command
};

inline DramModel::DramModel(const Context& context, DramClock data_clocks)
    : clocks_(context.core_mhz, context.params.clock_mhz),
      data_clocks_(data_clocks),
      stats_(context.parent, double(context.params.transfers_per_clock) * context.params.bus_bytes),
      capacity_(context.params.queue) {
}

}  // namespace glint::mem
