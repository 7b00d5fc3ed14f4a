// SPDX-License-Identifier: MIT
//
// Runs two kernels from two .sk files of the same name, and prints their results.
#include <sk/sk.hpp>

#include <cstdio>
#include <vector>

#include "scale.sk.hpp"
#include "solver/scale.sk.hpp"

int main() try {
  sk::Device device;
  auto x = device.stream<float>({4});
  auto scaled = device.stream<float>({4});
  auto result = device.stream<float>({4});
  x.write(std::vector<float>{1, 2, 3, 4});
  scale(0.5f, x, scaled);
  solver::scale(scaled, result);
  for (float value : result.read()) std::printf("%g ", value);
} catch (const sk::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
