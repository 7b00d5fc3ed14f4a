// SPDX-License-Identifier: MIT
//
// Promises: a kernel's weight counts what is written, each function once, and what the program adds for each call.
#include "split/cost.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"

namespace skc::split {
namespace {

using namespace ir;

constexpr Type doubleType = Type::of(Scalar::Double);

/// The weight of `r = value(x)`, for a type of x and r.
template <class Value>
std::uint32_t weightOfValue(Type type, Value&& value) {
  Module module = testModule();
  KernelBuilder k(module, "sample");
  const VarId x = k.input("x", type), r = k.output("r", type);
  k.finish(block(assign(k.ref(r), value(k.ref(x)))));
  return weightOf(module, module.kernels[0]);
}

TEST_CASE("statements and expressions weigh one each") {
  CHECK(weightOfValue(floatType, [](ExprPtr x) { return x; }) == 3);
  CHECK(weightOfValue(floatType,
                      [](ExprPtr x) { return binary(BinaryOp::Mul, literal(2.0f), std::move(x)); }) == 5);
}

TEST_CASE("a loop weighs as much as one iteration") {
  Module module = testModule();
  KernelBuilder k(module, "sample");
  const VarId r = k.output("r", intType), i = k.local("i", intType);
  k.finish(
      block(forLoop(block(declare(i, literal(0))), binary(BinaryOp::Less, k.ref(i), literal(1000)),
                    block(assign(k.ref(i), BinaryOp::Add, literal(1))), block(assign(k.ref(r), k.ref(i))))));
  CHECK(weightOf(module, module.kernels[0]) == 4 + 8);
}

TEST_CASE("what the program must define weighs more") {
  const auto sine = [](ExprPtr x) { return intrinsic(Intrinsic::Sin, exprs(std::move(x))); };
  const auto root = [](ExprPtr x) { return intrinsic(Intrinsic::Sqrt, exprs(std::move(x))); };
  CHECK(weightOfValue(floatType, root) == 4);
  const std::uint32_t one = weightOfValue(floatType, sine) - 4;
  CHECK(one > 20);
  CHECK(weightOfValue(Type::of(Scalar::Float, 4), sine) - 4 == 4 * one);
  CHECK(weightOfValue(doubleType, root) > 4);
}

}  // namespace
}  // namespace skc::split
