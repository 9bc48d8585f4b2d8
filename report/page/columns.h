// Turns the report's document into the form that a page stores: side by side for all runs, so that it packs
// well.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

namespace glint::report {

// Returns page_data() turned by ninety degrees.
//  - "stats", "metrics" and "config" leave the runs and become columns, {name: [value of each run]}. A column
//    of one value stands for all runs, and null is what a run does not have.
//  - With more than 200,000 numbers of statistics, counts are added up over the instances of a unit, as every
//    figure shows them, and fractions and means of an instance are left out.
//  - A statistic that is in every run and instance exactly the quotient of two others is in "quotients" as
//    their two names.
//  - The files and programs of "source" appear once, in "listings".
//  - report/page/rows.h treats timelines and counts of sources.
//  - Pictures are left out, because the page has them as pictures, and applications, which are tables.
//  - Whole numbers are written without a fraction.
// web/src/document.js turns it back, and nothing is rounded.
nlohmann::ordered_json page_columns(const nlohmann::ordered_json& data);

}  // namespace glint::report
