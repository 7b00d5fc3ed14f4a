// SPDX-License-Identifier: MIT
#include "assemble/append/append_groups.hpp"

#include <array>

#include <catch2/catch.hpp>

namespace sk::assemble {
namespace {

using program::Parameter;
using program::Role;
using program::ScatterOp;

constexpr program::Field intField{"", program::Scalar::Int, 1, 0}, pairField{"", program::Scalar::Int, 2, 0},
    floatField{"", program::Scalar::Float, 1, 0}, fourField{"", program::Scalar::Float, 4, 0};
constexpr program::Element ints{"int", "int", 4, {&intField, 1}}, pairs{"int2", "ivec2", 8, {&pairField, 1}},
    floats{"float", "float", 4, {&floatField, 1}}, fours{"float4", "vec4", 16, {&fourField, 1}};

GroupPlan planFor(const program::Element& element, std::int32_t pushes, bool isPacked) {
  const std::array parameters{Parameter{
      .name = "r", .symbol = "r", .role = Role::VariableOutput, .element = &element, .pushes = pushes}};
  program::Kernel kernel;
  kernel.parameters = parameters;
  return planGroups(kernel, isPacked, Order::Kept);
}

Parameter scatterOf(const program::Element& element, ScatterOp operation) {
  return {.name = "r",
          .symbol = "r",
          .role = Role::Scatter,
          .element = &element,
          .rank = 1,
          .scatter = operation};
}

TEST_CASE("pushes go through shared memory if a tile's fit there") {
  const auto isPlan = [](const GroupPlan& plan, int rounds, bool isStaged, bool isHeld = false) {
    return plan.rounds == rounds && plan.isStaged == isStaged && plan.isHeld == isHeld;
  };
  CHECK(isPlan(planFor(floats, 1, true), 4, true, true));
  CHECK(isPlan(planFor(floats, 1, false), 8, true, true));
  CHECK(isPlan(planFor(floats, 2, true), 2, true));
  CHECK(isPlan(planFor(fours, 1, false), 4, true, true));
  CHECK(isPlan(planFor(fours, 2, false), 2, true));
  CHECK(isPlan(planFor(fours, 4, false), 8, false));
  CHECK(isPlan(planFor(floats, -1, false), 8, false));
  CHECK(isPlan(planFor(floats, 0, false), 8, false));
}

TEST_CASE("what compute programs combine by way of records") {
  for (const Order order : {Order::Kept, Order::Any}) {
    CHECK_FALSE(isListed(scatterOf(pairs, ScatterOp::Store), order));
    CHECK(isListed(scatterOf(pairs, ScatterOp::Add), order));
    CHECK_FALSE(isListed(scatterOf(ints, ScatterOp::Add), order));
    CHECK_FALSE(isListed(scatterOf(floats, ScatterOp::Max), order));
    CHECK(isListed(scatterOf(floats, ScatterOp::Add), order) == (order == Order::Kept));
    CHECK(hasOwners(scatterOf(pairs, ScatterOp::Store), order));
    CHECK(hasOwners(scatterOf(ints, ScatterOp::Store), order) == (order == Order::Kept));
    CHECK_FALSE(hasOwners(scatterOf(ints, ScatterOp::Add), order));
  }
}

}  // namespace
}  // namespace sk::assemble
