// SPDX-License-Identifier: MIT
#include "support/devices.hpp"

#include <cstdlib>
#include <map>
#include <string>
#include <utility>

namespace run_tests {

sk::Device& device(std::string_view profile, int textureLimit) {
  // Never destroyed: some drivers shut down before our static objects are destroyed.
  static auto& devices = *new std::map<std::pair<std::string, int>, sk::Device>;
  const char* const compute = std::getenv("SK_TEST_COMPUTE");
  const std::pair key{std::string(profile), textureLimit};
  auto found = devices.find(key);
  if (found == devices.end()) {
    const bool isOther = compute != nullptr && profile == "glsl430";
    const sk::DeviceOptions options{.profile = isOther ? compute : key.first, .textureLimit = textureLimit};
    found = devices.emplace(key, profile == "native" ? sk::Device::native() : sk::Device(options)).first;
  }
  return found->second;
}

void detail::onLayouts(std::span<const Layout> chosen, void (*call)(const void* test, sk::Device& device),
                       const void* test) {
  for (const Layout& layout : chosen) {
    INFO("profile " << layout.profile << ", texture limit " << layout.textureLimit);
    call(test, device(layout.profile, layout.textureLimit));
  }
  INFO("native");
  call(test, device("native"));
}

}  // namespace run_tests
