// SPDX-License-Identifier: MIT
//
// Promises: sums of floats get a variant that is valid IR, with one more accumulator each; anything that is
// not such a sum, also in the combining reduce, does not. (tests/run/sums_test.cpp checks values.)
#include "transforms/passes.hpp"

#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;

/// reduce void r(T x<>, float weights[], reduce T total<>) { total op= x * T(weights[0]); }
Module reduceModule(Type type, BinaryOp op, bool withGather = false) {
  Module module = testModule();
  KernelBuilder builder(module, "r");
  const VarId x = builder.input("x", type);
  const VarId weights = withGather ? builder.gather("weights", floatType, 1) : 0;
  const VarId total = builder.accumulator("total", type);
  ExprPtr value = builder.ref(x);
  if (withGather) {
    value = binary(BinaryOp::Mul, std::move(value),
                   gatherRead(floatType, KernelBuilder::stream(weights), literal(0)));
  }
  builder.finish(block(assign(builder.ref(total), op, std::move(value))));
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
    REQUIRE(made->sums.size() == 1);
    CHECK(made->sums[0].accumulator == (withGather ? 2U : 1U));
    CHECK(made->sums[0].members.empty());
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
  KernelBuilder builder(module, "r");
  const VarId x = builder.input("x", floatType);
  const VarId total = builder.accumulator("total", floatType);
  builder.finish(
      block(assign(builder.ref(total), BinaryOp::Add, call(module, helper, exprs(builder.ref(x))))));
  transform(module);   // validates that each function belongs to one kernel
  CHECK(second(module) != nullptr);
}

TEST_CASE("vectors of floats are summed so, too") {
  Module module = reduceModule(Type::of(Scalar::Float, 3), BinaryOp::Add);
  transform(module);
  CHECK(second(module) != nullptr);
}

TEST_CASE("an element that adds one input, or the product of two, tells these") {
  const auto termOf = [](auto&& value) {
    Module module = testModule();
    KernelBuilder builder(module, "r");
    const VarId x = builder.input("x", floatType);
    const VarId y = builder.input("y", floatType);
    const VarId total = builder.accumulator("total", floatType);
    builder.finish(block(assign(builder.ref(total), BinaryOp::Add, value(builder.ref(x), builder.ref(y)))));
    transform(module);
    REQUIRE(second(module) != nullptr);
    return second(module)->term;
  };
  const auto with = [](BinaryOp op) {
    return [op](ExprPtr x, ExprPtr y) { return binary(op, std::move(x), std::move(y)); };
  };
  using Inputs = std::vector<VarId>;
  CHECK(termOf([](ExprPtr x, ExprPtr) { return x; }) == Inputs{0});
  CHECK(termOf(with(BinaryOp::Mul)) == Inputs{0, 1});
  CHECK(termOf(with(BinaryOp::Sub)).empty());
  CHECK(termOf(with(BinaryOp::Div)).empty());
  CHECK(termOf([](ExprPtr x, ExprPtr) { return unary(UnaryOp::Negate, std::move(x)); }).empty());
  CHECK(
      termOf([](ExprPtr x, ExprPtr) { return binary(BinaryOp::Mul, std::move(x), literal(2.0F)); }).empty());
}

/// struct Stats { float sum; float3 v; int count; };
Type addStats(Module& module) {
  const Type vector = Type::of(Scalar::Float, 3);
  module.structs.push_back({"Stats", {}, {{"sum", floatType}, {"v", vector}, {"count", intType}}, {}});
  return Type::structType(static_cast<std::uint32_t>(module.structs.size() - 1));
}
ExprPtr field(const Module& module, const KernelBuilder& builder, VarId var, std::uint32_t number) {
  return member(module, builder.ref(var), number);
}

TEST_CASE("members that are only added to are summed so, others are folded as ever") {
  Module module = testModule();
  const Type stats = addStats(module);
  KernelBuilder builder(module, "r");
  const VarId x = builder.input("x", floatType);
  const VarId total = builder.accumulator("total", stats);
  const auto component = [&](std::string_view name) {
    return swizzle(field(module, builder, total, 1), name);
  };
  Block body;
  body.push_back(assign(field(module, builder, total, 0), BinaryOp::Add, builder.ref(x)));
  body.push_back(assign(component("xz"), BinaryOp::Add, builder.ref(x)));
  body.push_back(assign(component("y"), intrinsic(Intrinsic::Max, exprs(component("y"), builder.ref(x)))));
  body.push_back(assign(field(module, builder, total, 2), BinaryOp::Add, literal(1)));
  builder.finish(std::move(body));
  transform(module);
  const Compensated* made = second(module);
  REQUIRE(made != nullptr);
  REQUIRE(made->sums.size() == 2);
  CHECK(made->sums[0].members == std::vector<std::uint32_t>{0});
  CHECK(made->sums[1].members == std::vector<std::uint32_t>{1});
  CHECK(module.kernels[made->fold].params.back().name == "total_v_lost");
  CHECK(module.kernels[made->finish].params.size() == 4);   // the accumulator, both errors, the result
}

/// reduce void r(float x<>, reduce Stats total<> = ...) { total.sum += x; }, combined by `combine`.
template <class Combine>
Module combinedBy(Combine&& combine) {
  Module module = testModule();
  const Type stats = addStats(module);
  const auto identity = [&] {
    return construct(
        stats, exprs(literal(0.0F), construct(Type::of(Scalar::Float, 3), exprs(literal(0.0F))), literal(0)));
  };
  KernelBuilder builder(module, "r");
  const VarId x = builder.input("x", floatType);
  const VarId total = builder.accumulator("total", stats, identity());
  builder.finish(block(assign(field(module, builder, total, 0), BinaryOp::Add, builder.ref(x))));
  KernelBuilder other(module, "r");
  const VarId part = other.input("part", stats);
  const VarId whole = other.accumulator("total", stats, identity());
  Block body;
  body.push_back(
      assign(field(module, other, whole, 0), BinaryOp::Add, combine(field(module, other, part, 0))));
  other.finish(std::move(body));
  module.kernels[0].reduction->combine = 1;
  module.kernels[0].reduction->operands = {0, 0};
  return module;
}

TEST_CASE("the author's combination counts where it adds the part and no more") {
  Module adds = combinedBy([](ExprPtr part) { return part; });
  transform(adds);
  REQUIRE(second(adds) != nullptr);
  CHECK(*adds.kernels[second(adds)->fold].reduction->combine != 1);
  Module scales =
      combinedBy([](ExprPtr part) { return binary(BinaryOp::Mul, std::move(part), literal(1.0F)); });
  transform(scales);
  CHECK(second(scales) == nullptr);
}

TEST_CASE("what is read besides, or added to in the head of a loop, is no sum") {
  for (const bool isRead : {true, false}) {
    Module module = testModule();
    KernelBuilder builder(module, "r");
    const VarId x = builder.input("x", floatType);
    const VarId total = builder.accumulator("total", floatType, literal(0.0F));
    const VarId i = builder.local("i", intType);
    Block add = block(assign(builder.ref(total), BinaryOp::Add, builder.ref(x)));
    if (isRead) {
      ExprPtr zero = binary(BinaryOp::Sub, builder.ref(total), builder.ref(total));
      builder.finish(block(ifStmt(binary(BinaryOp::Less, std::move(zero), literal(1.0F)), std::move(add))));
    } else {
      builder.finish(
          block(forLoop(block(declare(i, literal(0))), binary(BinaryOp::Less, builder.ref(i), literal(1)),
                        std::move(add), block(assign(builder.ref(i), BinaryOp::Add, literal(1))))));
    }
    transform(module);
    CHECK(second(module) == nullptr);
  }
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
