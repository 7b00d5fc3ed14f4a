// SPDX-License-Identifier: MIT
//
// Calls a kernel on the native device: check.sh debugs this program, and other tests check its error if no native code fits
// the CPU.
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
  const float first = v.read()[0];
  pick(v, u, u);
  return first;
}

}  // namespace

int main() try { return firstOfHeat() == 22.0F ? 0 : 1; } catch (const sk::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
