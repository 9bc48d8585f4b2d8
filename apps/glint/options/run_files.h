// Says what a reader of runs should know of their files, beside what is an error.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace glint::app {

// Prints to stderr which runs were ended early, which have no list of their files, and which files of a list
// are gone. The directories are those of runs that could be read.
void tell_of_files(const std::vector<std::string>& directories);

}  // namespace glint::app
