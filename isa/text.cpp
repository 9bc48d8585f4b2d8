// Placeholder for the build.
// SPDX-License-Identifier: Apache-2.0
