// SPDX-License-Identifier: MIT
//
// A program for check.sh to stop in: one call of a kernel on the native device.
#include <vector>

#include "debugger/heat.sk.hpp"
#include "sk/sk.hpp"

int main() {
  sk::Device device = sk::Device::native();
  auto u = device.stream<float>({4});
  auto v = device.stream<float>({4});
  u.write(std::vector<float>{1, 2, 3, 4});
  heat(0.5F, u, v);
  return v.read()[0] == 22.0F ? 0 : 1;
}
