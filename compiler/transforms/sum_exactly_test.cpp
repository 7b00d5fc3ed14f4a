// SPDX-License-Identifier: MIT
//
// Promises: each scalar that is a sum of floats gets an exact variant that is valid IR, with twice as many
// digits for sums of products; other scalars get none. Its term consists of inputs, or is a kernel with
// outputs for all terms of an element, unless terms are added in a loop. (tests/numerics checks values.)
#include "transforms/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;

const std::vector<ExactSum>& findExactSums(Module& module) {
  DiagnosticLog log;
  specializeGathers(module, log);
  deriveCombine(module, log);
  REQUIRE_FALSE(log.hasErrors());
  compensateSums(module, log);
  sumExactly(module, log);
  CHECK(validate(module, Stage::Specialized) == "");
  return module.kernels[0].reduction->exact;
}

/// reduce void r(reduce T total<>, T x<>, float weights[]) { total op= value; }, value built from an element.
template <class Value>
Module exactReduce(Type type, BinaryOp op, Value&& value) {
  Module module = testModule();
  KernelBuilder builder(module, "r");
  const VarId total = builder.accumulator("total", type);
  const VarId x = builder.input("x", type);
  const VarId weights = builder.gather("weights", floatType, 1);
  ExprPtr weight = gatherRead(floatType, KernelBuilder::stream(weights), literal(0));
  builder.finish(block(assign(builder.ref(total), op, value(builder.ref(x), std::move(weight)))));
  return module;
}

ExprPtr element(ExprPtr x, ExprPtr) { return x; }
ExprPtr weighted(ExprPtr x, ExprPtr weight) { return binary(BinaryOp::Mul, std::move(x), std::move(weight)); }

std::size_t accumulators(const Module& module, const ExactSum& sum) {
  std::size_t count = 0;
  for (const KernelParam& param : module.kernels[sum.fold].params) {
    count += param.role == ParamRole::Accumulator ? 1 : 0;
  }
  return count;
}

TEST_CASE("a sum of floats has three groups of digits and flags, of products six") {
  Module plain = exactReduce(floatType, BinaryOp::Add, element);
  const std::vector<ExactSum>& sums = findExactSums(plain);
  REQUIRE(sums.size() == 1);
  CHECK(accumulators(plain, sums[0]) == 4);
  CHECK(sums[0].accumulator == 0);
  Module products = exactReduce(floatType, BinaryOp::Add, weighted);
  CHECK(accumulators(products, findExactSums(products).at(0)) == 7);
}

TEST_CASE("a vector has a form for each component, and one combination") {
  Module module = exactReduce(Type::of(Scalar::Float, 3), BinaryOp::Add, weighted);
  const std::vector<ExactSum>& sums = findExactSums(module);
  REQUIRE(sums.size() == 3);
  CHECK(module.kernels[sums[0].fold].reduction->combine == module.kernels[sums[2].fold].reduction->combine);
}

std::size_t outputs(const Module& module, KernelId id) {
  std::size_t count = 0;
  for (const KernelParam& param : module.kernels[id].params) count += param.role == ParamRole::Output ? 1 : 0;
  return count;
}

/// reduce void r(reduce float total<>, float x<>), with a body built from `total += x`.
template <class Body>
Module moduleAround(Body&& body) {
  Module module = testModule();
  KernelBuilder builder(module, "r");
  const VarId total = builder.accumulator("total", floatType);
  const VarId x = builder.input("x", floatType);
  const auto isPositive = [&] { return binary(BinaryOp::Greater, builder.ref(x), literal(0.0F)); };
  builder.finish(body(assign(builder.ref(total), BinaryOp::Add, builder.ref(x)), isPositive()));
  return module;
}

TEST_CASE("a term of inputs names them, and any other has a kernel") {
  Module plain = exactReduce(floatType, BinaryOp::Add, element);
  const ExactTerm inputs = findExactSums(plain).at(0).term;
  CHECK(inputs.factors == std::vector<VarId>{1});
  CHECK_FALSE(inputs.kernel);
  Module products = exactReduce(floatType, BinaryOp::Add, weighted);
  const ExactTerm computed = findExactSums(products).at(0).term;
  REQUIRE(computed.kernel);
  CHECK(outputs(products, *computed.kernel) == 2);
  CHECK(products.kernels[*computed.kernel].isNativeOnly);
  CHECK_FALSE(products.kernels[*computed.kernel].reduction);
}

TEST_CASE("an element may leave a term out, by a branch around it or a return before") {
  Module branch = moduleAround(
      [](Stmt sum, ExprPtr cond) { return block(ifStmt(std::move(cond), block(std::move(sum)))); });
  Module after = moduleAround([](Stmt sum, ExprPtr cond) {
    return block(ifStmt(std::move(cond), block(returnStmt())), std::move(sum));
  });
  for (Module* module : {&branch, &after}) {
    const ExactTerm term = findExactSums(*module).at(0).term;
    CHECK(term.factors.empty());
    REQUIRE(term.kernel);
    CHECK(outputs(*module, *term.kernel) == 1);
  }
}

TEST_CASE("a loop adds any number of terms") {
  Module module = moduleAround(
      [](Stmt sum, ExprPtr cond) { return block(whileLoop(std::move(cond), block(std::move(sum)))); });
  CHECK(findExactSums(module).at(0).term.isEmpty());
}

TEST_CASE("products, integers and doubles have no exact form") {
  Module product = exactReduce(floatType, BinaryOp::Mul, element);
  Module integers = exactReduce(intType, BinaryOp::Add, element);
  Module doubles = exactReduce(Type::of(Scalar::Double), BinaryOp::Add, element);
  for (Module* module : {&product, &integers, &doubles}) CHECK(findExactSums(*module).empty());
}

}  // namespace
}  // namespace skc
