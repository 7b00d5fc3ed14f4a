// SPDX-License-Identifier: MIT
//
// The source that the precompiled header of tests is made for: catch_main.cpp configures Catch2 and cannot use it.
