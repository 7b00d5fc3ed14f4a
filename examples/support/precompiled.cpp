// SPDX-License-Identifier: MIT
//
// The source for which the precompiled header of libraries is built.
