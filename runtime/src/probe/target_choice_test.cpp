// SPDX-License-Identifier: MIT
//
// Promises: the trial of one device is not used for another whose result could differ, and kernels are of the class whose
// programs they run.
#include "probe/target_choice.hpp"

#include <array>

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

TEST_CASE("kernels with append outputs are of the class that orders what they write") {
  using program::Role;
  const program::Field field{"", program::Scalar::Int, 2, 0};
  const program::Element pairs{"int2", "ivec2", 8, {&field, 1}};
  const auto classIn = [&](const program::Parameter& output, Order order) {
    const std::array parameters{output};
    program::Kernel kernel;
    kernel.parameters = parameters;
    return classOf(kernel, order);
  };
  const program::Parameter pushed{
      .name = "r", .symbol = "r", .role = Role::VariableOutput, .element = &pairs, .pushes = 1};
  program::Parameter scattered{
      .name = "r", .symbol = "r", .role = Role::Scatter, .element = &pairs, .rank = 1};
  CHECK(classIn(pushed, Order::Kept) == KernelClass::Pushes);
  CHECK(classIn(pushed, Order::Any) == KernelClass::Scatters);
  for (const Order order : {Order::Kept, Order::Any}) {
    scattered.scatter = program::ScatterOp::Store;
    CHECK(classIn(scattered, order) == KernelClass::Scatters);
    scattered.scatter = program::ScatterOp::Add;
    CHECK(classIn(scattered, order) == KernelClass::OrderedScatters);
  }
}
