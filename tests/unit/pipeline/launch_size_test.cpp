// Tests the limit of a launch.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/launch_size.h"

#include "tests/support/catch.h"

namespace glint::pipeline {
namespace {

TEST_CASE("a launch may have as many threads as 32 bits can number, and no more") {
  CHECK_NOTHROW(check_launch_size({0xffff'ffff, 1, 1}, {1, 1, 1}, {}));
  CHECK_NOTHROW(check_launch_size({65535, 1, 65537}, {1, 1, 1}, {}));  // 2^32 - 1
  CHECK_NOTHROW(check_launch_size({0, 0xffff'ffff, 0xffff'ffff}, {32, 1, 1}, {}));
  CHECK_THROWS_WITH(check_launch_size({65536, 65536, 1}, {1, 1, 1}, {"a.toml", 3, 0}),
                    "a.toml:3: error: a launch of 65536 x 65536 x 1 blocks of 1 threads has more than "
                    "4294967295 threads");
  CHECK_THROWS_AS(check_launch_size({0x0400'0000, 1, 1}, {8, 4, 2}, {}), UserError);
  CHECK_THROWS_AS(check_launch_size({0xffff'ffff, 0xffff'ffff, 0xffff'ffff}, {1024, 1, 1}, {}), UserError);
}

}  // namespace
}  // namespace glint::pipeline
