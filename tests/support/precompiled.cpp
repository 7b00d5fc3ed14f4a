// SPDX-License-Identifier: MIT
//
// The source for which the tests' precompiled header is built: catch_main.cpp configures Catch2 and cannot use it.
