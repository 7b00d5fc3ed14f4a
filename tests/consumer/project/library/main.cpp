// SPDX-License-Identifier: MIT
//
// Uses the library.
#include <cstdio>
#include <exception>

#include "library/shift.hpp"

int main() try { std::printf("%g", shifted(1)); } catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
