// SPDX-License-Identifier: MIT
#include "support/devices.hpp"

#include <cstdlib>
#include <map>
#include <string>
#include <utility>

namespace run_tests {

namespace {

constexpr std::string_view dispatched = "glsl430";

/// The profile that takes the place of `dispatched`, on which alone tests then run; null: all run.
const char* otherCompute() { return std::getenv("SK_TEST_COMPUTE"); }

}  // namespace

sk::Device& device(std::string_view profile, int textureLimit) {
  // Never destroyed: some drivers shut down before our static objects are destroyed.
  static auto& devices = *new std::map<std::pair<std::string, int>, sk::Device>;
  const char* const compute = otherCompute();
  const std::pair key{std::string(profile), textureLimit};
  auto found = devices.find(key);
  if (found == devices.end()) {
    const bool isOther = compute != nullptr && profile == dispatched;
    const sk::DeviceOptions options{.profile = isOther ? compute : key.first, .textureLimit = textureLimit};
    found = devices.emplace(key, profile == "native" ? sk::Device::native() : sk::Device(options)).first;
  }
  return found->second;
}

void detail::onLayouts(std::span<const Layout> chosen, void (*call)(const void* test, sk::Device& device),
                       const void* test) {
  for (const Layout& layout : chosen) {
    if (otherCompute() != nullptr && layout.profile != dispatched) continue;
    INFO("profile " << layout.profile << ", texture limit " << layout.textureLimit);
    call(test, device(layout.profile, layout.textureLimit));
  }
  if (otherCompute() != nullptr) return;
  INFO("native");
  call(test, device("native"));
}

}  // namespace run_tests
