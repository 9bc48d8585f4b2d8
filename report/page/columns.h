// The report's document as a page stores it: what all runs have side by side, so that it packs well.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

namespace glint::report {

// page_data() turned: "stats", "metrics" and "config" leave the runs and become columns, {name: [value of
// each run]}. A column of one value stands for all runs; null is what a run does not have. With more than
// 200,000 numbers of statistics, counts are added up over the instances of a unit, as every figure shows
// them, and shares and means of an instance are left out. A statistic that is in every run and instance
// exactly the quotient of two others stands in "quotients" as their two names. The files and programs of
// "source" stand once in "listings". Timelines and counts of sources are page_rows.h's. Pictures are left
// out: the page has them as pictures. Whole numbers are written as such. web/src/document.js turns it back;
// nothing is rounded.
nlohmann::ordered_json page_columns(const nlohmann::ordered_json& data);

}  // namespace glint::report
