// SPDX-License-Identifier: MIT
//
// Promises: code weighs what the question's weights say, a function at each call or once, and a loop as much as the limit.
#include "ir/op_weight.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"

namespace skc::ir {
namespace {

/// float twice(float x) { return x + x; }
FunctionId addTwice(Module& module) {
  Function twice{.name = "twice", .result = floatType, .variables = {}, .body = {}, .loc = {}};
  const VarId x = addVariable(twice, "x", floatType, VarRole::In);
  Block body = block(returnStmt(binary(BinaryOp::Add, varRef(twice, x), varRef(twice, x))));
  return addFunction(module, std::move(twice), std::move(body));
}

TEST_CASE("operations and intrinsics weigh by component, nodes one each") {
  const Module module = testModule();
  const Type pair = Type::of(Scalar::Float, 2);
  const auto sine = [&] {
    ExprPtr ones = construct(pair, exprs(literal(1.0F)));
    return block(returnStmt(intrinsic(Intrinsic::Sin, exprs(unary(UnaryOp::Negate, std::move(ones))))));
  };
  CHECK(weigh(module, sine(), {.operation = 1, .intrinsic = 4}, 100) == 2 * 1 + 2 * 4);
  CHECK(weigh(module, sine(), {.node = 1}, 100) == 4);
  CHECK(weigh(module, sine(), {.node = 1}, 3) == 3);
}

TEST_CASE("a read and a sample of a gather weigh once, whatever their width") {
  Module module = testModule();
  KernelBuilder k(module, "k");
  const Type pair = Type::of(Scalar::Float, 2);
  const VarId u = k.gather("u", pair, 1);
  const Block read = block(returnStmt(gatherRead(pair, KernelBuilder::stream(u), literal(0))));
  CHECK(weigh(module, read, {.gather = 5, .sample = 7}, 100) == 5);
  const Block sampled = block(returnStmt(makeExpr(pair, Sample{KernelBuilder::stream(u), literal(0.0F)})));
  CHECK(weigh(module, sampled, {.gather = 5, .sample = 7}, 100) == 7);
}

TEST_CASE("a function weighs at each of its calls, or once") {
  Module module = testModule();
  const FunctionId twice = addTwice(module);
  const auto one = [&] { return call(module, twice, exprs(literal(1.0F))); };
  const Block body = block(returnStmt(binary(BinaryOp::Mul, one(), one())));
  CHECK(weigh(module, body, {.operation = 1}, 100) == 1 + 2);
  CHECK(weigh(module, body, {.operation = 1, .countsCalls = false}, 100) == 1 + 1);
}

TEST_CASE("a loop weighs as much as the limit") {
  const Module module = testModule();
  CHECK(weigh(module, block(whileLoop(literal(true), block(breakStmt()))), {}, 12) == 12);
}

}  // namespace
}  // namespace skc::ir
