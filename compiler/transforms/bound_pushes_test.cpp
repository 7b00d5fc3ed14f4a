// SPDX-License-Identifier: MIT
//
// Promises: a bound is never below what one element can execute; it is known if every loop around a push has
// a known trip count; a scatter output has one kind of operation.
#include "transforms/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;

constexpr StreamRef appendOutput = {StreamRef::Space::KernelParameter, 1};

Stmt pushOne() { return push(appendOutput, literal(1.0F)); }

/// The bound of a kernel with this body, in which variable 2 is an int.
std::int32_t boundOf(Block body) {
  Module module = testModule();
  KernelBuilder k(module, "f");
  k.input("x", floatType);
  k.variableOutput("r", floatType);
  k.local("i", Type::of(Scalar::Int));
  k.finish(std::move(body));
  DiagnosticLog log;
  boundPushes(module, log);
  return module.kernels.front().params[1].pushes;
}

ExprPtr counter() { return makeExpr(Type::of(Scalar::Int), VarRef{2}); }

Stmt loopTo(std::int32_t end, Block body) {
  return forLoop(block(declare(2, literal(0))), binary(BinaryOp::Less, counter(), literal(end)),
                 block(assign(counter(), BinaryOp::Add, literal(2))), std::move(body));
}

TEST_CASE("statements add up, and branches count as the larger side") {
  CHECK(boundOf({}) == 0);
  CHECK(boundOf(block(pushOne(), pushOne())) == 2);
  CHECK(boundOf(block(ifStmt(literal(true), block(pushOne()), block(pushOne(), pushOne())))) == 2);
  CHECK(boundOf(block(scope(block(pushOne())), returnStmt(), pushOne())) == 2);
}

TEST_CASE("loops count where their rounds are known, or nothing is pushed in them") {
  CHECK(boundOf(block(loopTo(5, block(pushOne(), pushOne())))) == 6);
  CHECK(boundOf(block(loopTo(0, block(pushOne())))) == 0);
  CHECK(boundOf(block(whileLoop(literal(true), block(pushOne(), breakStmt())))) == -1);
  CHECK(boundOf(block(whileLoop(literal(true), block(breakStmt())), pushOne())) == 1);
  CHECK(boundOf(block(loopTo(5, block(pushOne(), assign(counter(), literal(0)))))) == -1);
  CHECK(boundOf(block(loopTo(1 << 30, block(pushOne())))) == -1);
}

TEST_CASE("a call counts as its callee") {
  Module module = testModule();
  Function helper;
  helper.name = "twice";
  const FunctionId id = addFunction(module, std::move(helper), block(pushOne(), pushOne()));
  KernelBuilder k(module, "f");
  k.input("x", floatType);
  k.variableOutput("r", floatType);
  k.finish(block(callStmt(id, {}), callStmt(id, {}), pushOne()));
  DiagnosticLog log;
  boundPushes(module, log);
  CHECK(module.kernels.front().params[1].pushes == 5);
}

TEST_CASE("a scatter output takes one kind of operation") {
  for (const ScatterOp second : {ScatterOp::Add, ScatterOp::Store}) {
    Module module = testModule();
    KernelBuilder k(module, "f");
    k.input("x", floatType);
    k.scatterOutput("r", floatType, 1);
    k.finish(block(scatter(appendOutput, ScatterOp::Add, literal(0), literal(1.0F)),
                   scatter(appendOutput, second, literal(1), literal(1.0F))));
    DiagnosticLog log;
    boundPushes(module, log);
    CHECK(log.hasErrors() == (second == ScatterOp::Store));
    CHECK(module.kernels.front().params[1].pushes == 2);
    if (second == ScatterOp::Add) CHECK(module.kernels.front().params[1].scatter == ScatterOp::Add);
  }
}

}  // namespace
}  // namespace skc
