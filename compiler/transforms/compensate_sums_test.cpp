// SPDX-License-Identifier: MIT
//
// Promises: sums of floats get a second form that is valid IR, with an accumulator more for each; what is no
// such sum, or combines by the author's own reduce, does not. (What it computes: tests/run/sums_test.cpp.)
#include "transforms/compensate_sums.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_maker.hpp"
#include "ir/validate.hpp"
#include "support/diagnostic_log.hpp"
#include "transforms/derive_combine.hpp"
#include "transforms/specialize_gathers.hpp"

namespace skc {
namespace {

using namespace ir;

/// reduce void r(T x<>, float weights[], reduce T total<>) { total op= x * T(weights[0]); }
Module reduceModule(Type type, BinaryOp op, bool withGather = false) {
  Module module = testModule();
  KernelMaker maker(module, "r");
  const VarId x = maker.input("x", type);
  const VarId weights = withGather ? maker.gather("weights", floatType, 1) : 0;
  const VarId total = maker.accumulator("total", type);
  ExprPtr value = maker.ref(x);
  if (withGather) {
    value = binary(BinaryOp::Mul, std::move(value),
                   gatherRead(floatType, KernelMaker::stream(weights), literal(0)));
  }
  maker.finish(block(assign(maker.ref(total), op, std::move(value))));
  return module;
}

void transform(Module& module) {
  DiagnosticLog log;
  specializeGathers(module, log);
  deriveCombine(module, log);
  REQUIRE_FALSE(log.hasErrors());
  compensateSums(module, log);
  CHECK(validate(module, Stage::Specialized) == "");
}

const Compensated* second(const Module& module) {
  const std::optional<Compensated>& found = module.kernels[0].reduction->compensated;
  return found ? &*found : nullptr;
}

TEST_CASE("a sum of floats gets an accumulator for what it loses") {
  for (const bool withGather : {false, true}) {
    Module module = reduceModule(floatType, BinaryOp::Add, withGather);
    transform(module);
    const Compensated* made = second(module);
    REQUIRE(made != nullptr);
    const Kernel& fold = module.kernels[made->fold];
    CHECK(fold.params.size() == module.kernels[0].params.size() + 1);
    CHECK(fold.params.back().role == ParamRole::Accumulator);
    CHECK(fold.params.back().name == "total_lost");
    CHECK(fold.name == "r");
    CHECK(module.kernels[made->finish].params.size() == 3);
    CHECK(made->sums == std::vector<VarId>{withGather ? 2U : 1U});
  }
}

TEST_CASE("functions that the fold calls are copied for the second form") {
  Module module = testModule();
  Function twice;
  twice.name = "twice";
  twice.result = floatType;
  const VarId v = addVariable(twice, "v", floatType, VarRole::In);
  Block body = block(returnStmt(binary(BinaryOp::Mul, varRef(twice, v), literal(2.0F))));
  const FunctionId helper = addFunction(module, std::move(twice), std::move(body));
  KernelMaker maker(module, "r");
  const VarId x = maker.input("x", floatType);
  const VarId total = maker.accumulator("total", floatType);
  maker.finish(block(assign(maker.ref(total), BinaryOp::Add, call(module, helper, exprs(maker.ref(x))))));
  transform(module);   // validates: a function belongs to one kernel
  CHECK(second(module) != nullptr);
}

TEST_CASE("vectors of floats are summed so, too") {
  Module module = reduceModule(Type::of(Scalar::Float, 3), BinaryOp::Add);
  transform(module);
  CHECK(second(module) != nullptr);
}

TEST_CASE("products, integers and doubles have no second form") {
  Module product = reduceModule(floatType, BinaryOp::Mul);
  Module integers = reduceModule(intType, BinaryOp::Add);
  Module doubles = reduceModule(Type::of(Scalar::Double), BinaryOp::Add);
  for (Module* module : {&product, &integers, &doubles}) {
    transform(*module);
    CHECK(second(*module) == nullptr);
  }
}

}  // namespace
}  // namespace skc
