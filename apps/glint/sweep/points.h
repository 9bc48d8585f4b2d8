// Checks the runs of a sweep before the first of them starts, and says what each of them depends on.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <iosfwd>
#include <string>

#include "apps/glint/session.h"

namespace glint::app {

// Reads one point from each line and writes one answer for each: lines of JSON (docs/sweeps.md). The first
// line that it writes says what all points depend on. A point that is wrong gets an answer with its error,
// and the others go on.
void describe_points(const Session& session, std::istream& points);

}  // namespace glint::app
