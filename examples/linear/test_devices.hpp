// SPDX-License-Identifier: MIT
//
// The devices of tests: native code, fragment programs and compute programs.
#pragma once

#include <vector>

#include <sk/sk.hpp>

namespace linear {

inline std::vector<sk::Device> testDevices() {
  std::vector<sk::Device> all;
  all.push_back(sk::Device::native());
  for (const char* profile : {"essl300", "glsl430"})
    all.emplace_back(sk::DeviceOptions{.device = "software", .profile = profile});
  return all;
}

}  // namespace linear
