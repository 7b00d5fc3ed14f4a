// SPDX-License-Identifier: MIT
//
// Promises: the bound is never below the iterations that the loops of one element, or of elements that are computed together,
// can take.
#include "analysis/iterations.hpp"

#include <utility>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"

namespace skc::analysis {
namespace {

using namespace ir;

/// The bound for a kernel with this body, in which variables 2 and 4 are ints and variable 3 is a long.
std::int64_t iterationsOf(Block body) {
  Module module = testModule();
  KernelBuilder k(module, "f");
  k.input("x", floatType);
  k.output("r", floatType);
  k.local("i", Type::of(Scalar::Int));
  k.local("n", Type::of(Scalar::Long));
  k.local("j", Type::of(Scalar::Int));
  k.finish(std::move(body));
  return mostIterations(module, module.kernels.front()).value_or(-1);
}

ExprPtr counterOf(VarId id) { return makeExpr(Type::of(Scalar::Int), VarRef{id}); }
ExprPtr number() { return makeExpr(Type::of(Scalar::Long), VarRef{3}); }

Stmt countTo(std::int32_t end, Block body, VarId id = 2) {
  return forLoop(block(declare(id, literal(0))), binary(BinaryOp::Less, counterOf(id), literal(end)),
                 block(assign(counterOf(id), BinaryOp::Add, literal(1))), std::move(body));
}

Stmt divideOnce() { return assign(number(), BinaryOp::Div, number()); }

TEST_CASE(
    "loops one after the other add up, and loops in loops multiply, with the last tests of their "
    "conditions") {
  CHECK(iterationsOf({}) == 0);
  CHECK(iterationsOf(block(countTo(9, {}))) == 10);
  CHECK(iterationsOf(block(countTo(9, {}), countTo(4, {}))) == 15);
  CHECK(iterationsOf(block(countTo(9, block(countTo(4, {}, 4))))) == 60);
  CHECK(iterationsOf(block(ifStmt(literal(true), block(countTo(9, {})), block(countTo(4, {}))))) == 15);
}

TEST_CASE("what has no bound, or a large one, is unknown") {
  CHECK(iterationsOf(block(whileLoop(literal(true), block(breakStmt())))) == -1);
  CHECK(iterationsOf(block(countTo(1 << 30, {}))) == -1);
  CHECK(iterationsOf(block(countTo(2000, block(countTo(2000, {}, 4))))) == -1);
}

TEST_CASE("divisions of integers of 64 bits are loops") {
  CHECK(iterationsOf(block(divideOnce())) == 65);
  CHECK(iterationsOf(block(assign(number(), binary(BinaryOp::Rem, number(), number())))) == 65);
}

}  // namespace
}  // namespace skc::analysis
