// Declares the parameters of shared memory and of the atomics in it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/params.h"

namespace glint::core {

// Holds the times of atomics that differ from those of an integer addition.
struct AtomicParams {
  uint32_t latency = 0, pass = 0, hidden = 0;
  static ParamList params() {
    return {param(&AtomicParams::latency, "latency", "cycle",
                  "Cycles from issue to the issue of a dependent instruction, for one lane. 0: all times are "
                  "those of integer atomics.",
                  0, 10000),
            param(&AtomicParams::pass, "pass", "cycle",
                  "Extra cycles of latency for each further turn of lanes that meet in a bank.", 0, 1000),
            param(&AtomicParams::hidden, "hidden", "cycle",
                  "Cycles of the further turns' latency, in total, that the latency of one lane hides.", 0,
                  1000)};
  }
};

// Holds the times of shared memory. Defaults: microbenchmarks of an H200, except for conflicts: there n lanes
// that meet in a bank keep the unit busy for n cycles and add 2n - 5 cycles of latency.
struct SharedParams {
  uint32_t latency = 23;         // dependent loads
  uint32_t atomic_latency = 76;  // dependent atom.shared.add.u32; 126 when 32 lanes meet in a word
  uint32_t atomic_pass = 2, atomic_hidden = 0, atomic_interval = 2;  // H200: 2, 12 and 1
  bool merges_counts = false;                                        // H200: true
  AtomicParams swap, float_add;
  uint32_t conflict_turn = 1, conflict_hidden = 0;
  static ParamList params() {
    return {
        param(
            &SharedParams::latency, "latency", "cycle",
            "Cycles from the issue of a load without bank conflicts to the issue of a dependent instruction.",
            1, 1000),
        param(&SharedParams::atomic_latency, "atomic_latency", "cycle",
              "Cycles from the issue of an atomic without bank conflicts to the issue of a dependent "
              "instruction.",
              1, 1000),
        param(&SharedParams::atomic_pass, "atomic_pass", "cycle",
              "Extra cycles of latency for each further turn of an atomic, when lanes meet in a bank.", 1,
              100),
        param(&SharedParams::atomic_interval, "atomic_interval", "cycle",
              "Cycles that each further turn of an atomic keeps shared memory busy.", 1, 100),
        flag(&SharedParams::merges_counts, "merges_counts",
             "True: lanes that add the constant one to the same word, and read no old value, take one turn. "
             "False: each takes a turn of its own."),
        param(&SharedParams::atomic_hidden, "atomic_hidden", "cycle",
              "Cycles of the further turns' latency, in total, that the latency of an atomic without "
              "conflicts hides.",
              0, 100),
        section(&SharedParams::swap, "swap", "Times of compare-and-swap."),
        section(&SharedParams::float_add, "float_add",
                "Times of atomic floating-point addition, for which hardware loops over compare-and-swap."),
        param(&SharedParams::conflict_turn, "conflict_turn", "cycle",
              "Extra cycles of latency for each further turn of a load that conflicts in a bank, also in "
              "global memory.",
              0, 100),
        param(&SharedParams::conflict_hidden, "conflict_hidden", "cycle",
              "Cycles of the further turns' latency, in total, that the latency of a load without conflicts "
              "hides.",
              0, 100)};
  }
};

}  // namespace glint::core
