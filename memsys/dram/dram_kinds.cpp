// Lists the named kinds of DRAM, with what their data sheets say of one channel.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "base/check.h"
#include "memsys/dram/dram_params.h"

namespace glint::mem {
namespace {

struct Kind {
  std::string_view name, doc;
  void (*apply)(DramParams&);
};

void set_times(DramParams& p, const std::array<double, 16>& t) {
  double* const fields[] = {&p.rcd, &p.rcd_write, &p.rp,    &p.ras,   &p.rc,    &p.cl,  &p.wl,    &p.wr,
                            &p.rtp, &p.ccd_s,     &p.ccd_l, &p.rrd_s, &p.rrd_l, &p.faw, &p.wtr_s, &p.wtr_l};
  static_assert(std::size(fields) == std::tuple_size_v<std::array<double, 16>>);
  for (size_t i = 0; i < t.size(); ++i) *fields[i] = t[i];
}
void set_refresh(DramParams& p, double refi, double rfc, double rfc_bank) {
  p.refi = refi, p.rfc = rfc, p.rfc_bank = rfc_bank;
}
void set_bus(DramParams& p, double clock_mhz, uint32_t transfers_per_clock, uint32_t burst,
             uint32_t bus_bytes) {
  p.clock_mhz = clock_mhz, p.transfers_per_clock = transfers_per_clock, p.burst = burst,
  p.bus_bytes = bus_bytes;
}
void set_array(DramParams& p, uint32_t row_bytes, bool dual_command_bus, uint32_t activate_clocks) {
  p.bank_groups = 4, p.banks = 16, p.row_bytes = row_bytes, p.bus_turn = 2;
  p.dual_command_bus = dual_command_bus, p.activate_clocks = activate_clocks;
}

// All times are from Ramulator 2.1's presets, with clocks turned into nanoseconds, unless a kind names
// another source or says "guess". Their order is rcd, rcd_write, rp, ras, rc, cl, wl, wr, rtp, ccd_s, ccd_l,
// rrd_s, rrd_l, faw, wtr_s, wtr_l.

// GDDR6-14000 at 1.35 V has a tCK of 0.57 ns. Refreshes are 3333 clocks apart and take 211 clocks for all
// banks or 106 for one bank.
void gddr6_14000(DramParams& p) {
  set_bus(p, 1750.0, 8, 16, 2);
  set_array(p, 2048, false, 1);
  set_times(p,
            {15.4, 9.2, 15.4, 30.2, 45.0, 13.7, 3.4, 15.4, 2.28, 1.14, 2.28, 4.56, 4.56, 16.5, 5.13, 6.27});
  set_refresh(p, 1900.0, 120.3, 60.4);
}
// This kind has half the transfers per clock: Vulkan-Sim's mobile part has 7 GT/s on a command clock of 1750
// MHz.
void gddr6_7000(DramParams& p) {
  gddr6_14000(p);
  p.transfers_per_clock = 4;
}
void gddr6_14000_1v25(DramParams& p) {
  gddr6_14000(p);
  set_times(p,
            {17.1, 11.4, 17.1, 34.2, 51.3, 13.7, 3.4, 15.4, 2.28, 1.14, 2.28, 6.27, 6.27, 24.5, 5.13, 6.27});
}
// No published times of GDDR6X were found.
// - 19 GT/s: NVIDIA's figures of the RTX 3080 (320 bits, 760 GB/s).
// - Channels of 16 bits, accesses of 32 bytes, a command clock of an eighth of the data rate, 16 banks in 4
//   groups, rows of 2 KB, 2 and 4 clocks for tCCD_S and tCCD_L: guess, as in GDDR6.
// - All other times and the refresh: guess, as GDDR6-14000 at 1.35 V.
void gddr6x_19000(DramParams& p) {
  gddr6_14000(p);
  set_bus(p, 2375.0, 8, 16, 2);
  p.ccd_s = 0.842, p.ccd_l = 1.684;
}
// No published times of GDDR7 were found.
// - 28 GT/s: NVIDIA's figures of the RTX 5090 (512 bits, 1792 GB/s).
// - Channels of 8 bits: JEDEC's announcement of JESD239 has four channels and 192 GB/s for a die at 48 GT/s.
// - 2 clocks of 571 ps for 32 bytes (16 PAM3 symbols on a lane, which count as 32 bits here), 16 banks
//   without groups, rows of 2 KB, 4 clocks from column to column command of one bank, 2 for an activate, 1900
//   ns from refresh to refresh: a model for Ramulator 2 that cites JESD239D. Here each bank is its own group.
// - Separate buses for row and column commands: that model, and press reports of two commands in parallel.
// - All other times: guess, as GDDR6-14000 at 1.25 V, from which that model takes them, too.
void gddr7_28000(DramParams& p) {
  gddr6_14000_1v25(p);
  set_bus(p, 1750.0, 16, 32, 1);
  set_array(p, 2048, true, 2);
  p.bank_groups = 16;
}
// LPDDR5-6400 has a tCK of 1.25 ns and 16-bit channels. An activate is two commands (ACT-1, ACT-2). Refreshes
// of 16 Gb dies are 3125 clocks apart and take 224 clocks for all banks or 112 for one bank.
void lpddr5_6400(DramParams& p) {
  set_bus(p, 800.0, 8, 16, 2);
  set_array(p, 2048, false, 2);
  set_times(
      p, {18.75, 18.75, 18.75, 42.5, 61.25, 21.25, 11.25, 35.0, 10.0, 2.5, 5.0, 5.0, 5.0, 20.0, 6.25, 12.5});
  set_refresh(p, 3906.25, 280.0, 140.0);
}
// A pseudo-channel of HBM3-6400 has a tCK of 0.625 ns. An activate takes 1.5 clocks of the row command bus.
// Refreshes are 6240 clocks apart and take 416 clocks for all banks (8 Gb per channel) or 320 for one bank.
void hbm3_6400(DramParams& p) {
  set_bus(p, 1600.0, 4, 8, 4);
  set_array(p, 1024, true, 2);
  set_times(p, {19.375, 9.375, 16.25, 28.125, 45.0, 12.5, 6.25, 20.625, 5.625, 1.25, 2.5, 2.5, 3.125, 15.0,
                4.375, 6.25});
  set_refresh(p, 3900.0, 260.0, 200.0);
}

constexpr Kind kKinds[] = {
    {"gddr6_7000", "GDDR6 at 7 GT/s with the times of GDDR6-14000 at 1.35 V; a 16-bit channel moves 14 GB/s.",
     gddr6_7000},
    {"gddr6_14000", "GDDR6-14000 at 1.35 V; a 16-bit channel moves 28 GB/s.", gddr6_14000},
    {"gddr6_14000_1v25",
     "GDDR6-14000 at 1.25 V; a 16-bit channel moves 28 GB/s, and rows are slower than at 1.35 V.",
     gddr6_14000_1v25},
    {"gddr6x_19000",
     "GDDR6X at 19 GT/s; a 16-bit channel moves 38 GB/s. Its times are guesses from GDDR6-14000 at 1.35 V.",
     gddr6x_19000},
    {"gddr7_28000",
     "GDDR7 at 28 GT/s; an 8-bit channel moves 28 GB/s. Its row times are guesses from GDDR6-14000 at 1.25 "
     "V.",
     gddr7_28000},
    {"lpddr5_6400", "LPDDR5-6400; a 16-bit channel moves 12.8 GB/s.", lpddr5_6400},
    {"hbm3_6400", "HBM3-6400; a 32-bit pseudo-channel moves 25.6 GB/s.", hbm3_6400}};

const Kind* find(std::string_view name) {
  const auto kind =
      std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& k) { return k.name == name; });
  return kind == std::end(kKinds) ? nullptr : &*kind;
}

}  // namespace

std::vector<std::string> dram_kinds() {
  std::vector<std::string> out;
  for (const Kind& kind : kKinds) out.emplace_back(kind.name);
  return out;
}

std::string_view dram_kind_doc(std::string_view name) {
  const Kind* kind = find(name);
  return kind ? kind->doc : std::string_view();
}

void apply_dram_kind(DramParams& params, std::string_view name) {
  const Kind* kind = find(name);
  GLINT_CHECK(kind, "no kind of DRAM is named '{}'", name);
  kind->apply(params);
  params.kind = name;
}

std::vector<std::string> refresh_modes() {
  return {"none", "all_bank", "per_bank"};
}

}  // namespace glint::mem
