// Has a mistake in line 6.
// SPDX-License-Identifier: Apache-2.0

int f() {
  int x = 1;
  return nothing + x;
}
