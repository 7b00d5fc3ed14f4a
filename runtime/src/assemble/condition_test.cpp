// SPDX-License-Identifier: MIT
//
// Promises: conditions follow C++'s rules for the type of their operands, and literals keep every bit.
#include "assemble/condition.hpp"

#include <bit>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

namespace sk::assemble {
namespace {

using program::ConditionOp;
using program::ConditionStep;
using program::Scalar;

bool evaluated(const std::vector<ConditionStep>& steps, const SpecValues& specs) {
  return holds({.steps = steps}, specs);
}

TEST_CASE("comparisons go by type") {
  const auto less = [](Scalar scalar, std::uint32_t a, std::uint32_t b) {
    return evaluated(
        {{ConditionOp::Spec, scalar, 0}, {ConditionOp::Literal, scalar, b}, {ConditionOp::Less, scalar}},
        {a});
  };
  CHECK(less(Scalar::Int, 0xFFFFFFFFu, 1u));
  CHECK_FALSE(less(Scalar::Uint, 0xFFFFFFFFu, 1u));
  CHECK(less(Scalar::Float, std::bit_cast<std::uint32_t>(-1.0F), std::bit_cast<std::uint32_t>(0.5F)));
  CHECK_FALSE(less(Scalar::Float, std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN()), 0u));
}

TEST_CASE("arithmetic wraps, logic combines") {
  // (a + 1) * 2 == 0 || !b
  const std::vector<ConditionStep> steps = {
      {ConditionOp::Spec, Scalar::Int, 0}, {ConditionOp::Literal, Scalar::Int, 1},
      {ConditionOp::Add, Scalar::Int},     {ConditionOp::Literal, Scalar::Int, 2},
      {ConditionOp::Mul, Scalar::Int},     {ConditionOp::Literal, Scalar::Int, 0},
      {ConditionOp::Equal, Scalar::Int},   {ConditionOp::Spec, Scalar::Bool, 1},
      {ConditionOp::Not, Scalar::Bool},    {ConditionOp::Or, Scalar::Bool}};
  CHECK(evaluated(steps, {0x7FFFFFFFu, 1u}));
  CHECK(evaluated(steps, {5u, 0u}));
  CHECK_FALSE(evaluated(steps, {5u, 1u}));
}

TEST_CASE("values as GLSL") {
  const auto ofFloat = [](float value) {
    return glslLiteral(Scalar::Float, std::bit_cast<std::uint32_t>(value));
  };
  CHECK(glslLiteral(Scalar::Bool, 1) == "true");
  CHECK(glslLiteral(Scalar::Int, 0xFFFFFFFFu) == "-1");
  CHECK(glslLiteral(Scalar::Int, 0x80000000u) == "(-2147483647 - 1)");
  CHECK(glslLiteral(Scalar::Uint, 0xFFFFFFFFu) == "4294967295u");
  CHECK(ofFloat(2.0F) == "2.0");
  CHECK(ofFloat(0.1F) == "0.1");
  CHECK(ofFloat(1e20F) == "1e+20");
  CHECK(ofFloat(-0.0F) == "-0.0");
  CHECK(ofFloat(std::numeric_limits<float>::infinity()) == "uintBitsToFloat(2139095040u)");
}

}  // namespace
}  // namespace sk::assemble
