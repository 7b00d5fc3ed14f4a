// SPDX-License-Identifier: MIT
//
// One call of a kernel on the native device: a program for check.sh to stop in, and one that tells why native code does not run.
#include <cstdio>
#include <vector>

#include "debugger/heat.sk.hpp"
#include "sk/sk.hpp"

namespace {

float firstOfHeat() {
  sk::Device device = sk::Device::native();
  auto u = device.stream<float>({4});
  auto v = device.stream<float>({4});
  u.write(std::vector<float>{1, 2, 3, 4});
  heat(0.5F, u, v);
  return v.read()[0];
}

}  // namespace

int main() try { return firstOfHeat() == 22.0F ? 0 : 1; } catch (const sk::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
