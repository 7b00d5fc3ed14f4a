// SPDX-License-Identifier: MIT
//
// A library with a kernel that its users do not see.
#include "library/shift.hpp"

#include <sk/sk.hpp>

#include "library/shift.sk.hpp"

float shifted(float value) {
  sk::Device device;
  auto x = device.stream<float>({1});
  auto r = device.stream<float>({1});
  x.write(std::vector<float>{value});
  shift(0.5f, x, r);
  return r.read().front();
}
