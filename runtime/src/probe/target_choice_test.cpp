// SPDX-License-Identifier: MIT
//
// Promises: the trial of one device is not used for another whose result could differ.
#include "probe/target_choice.hpp"

#include <catch2/catch.hpp>

using namespace sk;

TEST_CASE("trials are kept for a driver, its limits and, of software, the processor") {
  const DeviceLimits large{.textureSize = 16384, .textureLayers = 2048};
  DeviceLimits small = large, few = large;
  small.textureSize = 64;
  few.textureLayers = 16;
  const std::string gpu = trialKey("a GPU", large, false);
  CHECK(trialKey("a GPU", large, false) == gpu);
  CHECK(trialKey("another", large, false) != gpu);
  CHECK(trialKey("a GPU", small, false) != gpu);
  CHECK(trialKey("a GPU", few, false) != gpu);
  const std::string software = trialKey("a renderer", large, true);
  CHECK(software.find("threads") != std::string::npos);
  CHECK(software != trialKey("a renderer", large, false));
}
