// Says what the process is that has loaded the driver, and what it has allocated.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::vulkan {

// Returns the words of the command line, or none where the system does not tell.
std::vector<std::string> command_of_process();
// Returns the name of the program as a file's name may have it: "vkcube" of "/usr/bin/vkcube".
std::string program_of_process();

// Counts the bytes of the heap that all devices of all instances in the process have. VK_EXT_memory_budget
// speaks of the process.
std::atomic<uint64_t>& used_by_process();

}  // namespace glint::vulkan
