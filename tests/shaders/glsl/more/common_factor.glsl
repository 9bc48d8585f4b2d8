// Ends an include chain.
// SPDX-License-Identifier: Apache-2.0
#define BASE_FACTOR 6u
