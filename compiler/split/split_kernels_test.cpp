// SPDX-License-Identifier: MIT
//
// Promises: the passes of a plan keep to the limits and write every output once; expensive values needed
// twice are saved, cheap ones recomputed; planes are stacked if texture units run out.
#include "split/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/validate.hpp"
#include "split/slice.hpp"

namespace skc::split {
namespace {

using namespace ir;
using enum BinaryOp;

constexpr Limits narrow = {4, 16};

/// `outputs` outputs, each t plus a number; t is x, multiplied by itself `rounds` times.
Module sharedValue(int outputs, std::int32_t rounds) {
  Module module = testModule();
  KernelBuilder k(module, "shared");
  const VarId x = k.input("x", floatType);
  std::vector<VarId> r;
  for (int i = 0; i < outputs; ++i) r.push_back(k.output("r" + std::to_string(i), floatType));
  const VarId t = k.local("t", floatType), i = k.local("i", intType);
  Block body = block(declare(t, k.ref(x)));
  body.push_back(forLoop(block(declare(i, literal(0))), binary(Less, k.ref(i), literal(rounds)),
                         block(assign(k.ref(i), Add, literal(1))), block(assign(k.ref(t), Mul, k.ref(x)))));
  for (int j = 0; j < outputs; ++j) {
    body.push_back(
        assign(k.ref(r[static_cast<std::size_t>(j)]), binary(Add, k.ref(t), literal(static_cast<float>(j)))));
  }
  k.finish(std::move(body));
  return module;
}

void split(Module& module) {
  REQUIRE(validate(module, Stage::Specialized).empty());
  splitKernels(module, std::span(&narrow, 1));
  REQUIRE(validate(module, Stage::Specialized).empty());
}

/// The number of times that the passes write each argument of the whole kernel.
std::vector<int> writes(const Module& module, const Plan& plan) {
  std::vector<int> count(module.kernels[0].params.size(), 0);
  for (const Pass& pass : plan.passes) {
    const Kernel& kernel = module.kernels[pass.kernel];
    CHECK(demandOf(module, kernel).drawBuffers <= narrow.drawBuffers);
    for (std::size_t i = 0; i < pass.operands.size(); ++i) {
      const bool isOutput = kernel.params[i].role == ParamRole::Output;
      if (isOutput && !pass.operands[i].isTemporary) ++count[pass.operands[i].index];
    }
  }
  return count;
}

TEST_CASE("a kernel within the limits has no plan") {
  Module module = sharedValue(4, 100);
  split(module);
  CHECK(module.kernels.size() == 1);
  CHECK(module.kernels[0].plans.empty());
}

TEST_CASE("what is costly is saved") {
  Module module = sharedValue(6, 1000);
  split(module);
  REQUIRE(module.kernels[0].plans.size() == 1);
  const Plan& plan = module.kernels[0].plans[0];
  REQUIRE(plan.temporaries.size() == 1);
  CHECK(plan.temporaries[0].name == "t");
  CHECK(plan.temporaries[0].readers == 1);
  CHECK(plan.passes.size() == 2);
  CHECK(plan.cost < plan.costWithoutTemporaries);
  CHECK(writes(module, plan) == std::vector<int>{0, 1, 1, 1, 1, 1, 1});
  // the pass that loads it must not compute it
  const Kernel& last = module.kernels[plan.passes[1].kernel];
  CHECK(module.functions[last.entry].body.size() == 3);
}

TEST_CASE("what is cheap is computed again") {
  Module module = sharedValue(6, 3);
  split(module);
  REQUIRE(module.kernels[0].plans.size() == 1);
  const Plan& plan = module.kernels[0].plans[0];
  CHECK(plan.temporaries.empty());
  CHECK(plan.passes.size() == 2);
  CHECK(plan.cost == plan.costWithoutTemporaries);
  CHECK(writes(module, plan) == std::vector<int>{0, 1, 1, 1, 1, 1, 1});
}

TEST_CASE("outputs of unlike inputs go apart") {
  Module module = testModule();
  KernelBuilder k(module, "pairs");
  std::vector<VarId> x, r;
  for (int i = 0; i < 20; ++i) x.push_back(k.input("x" + std::to_string(i), floatType));
  for (int i = 0; i < 2; ++i) r.push_back(k.output("r" + std::to_string(i), floatType));
  Block body;
  for (std::size_t half = 0; half < 2; ++half) {
    ExprPtr sum = k.ref(x[10 * half]);
    for (std::size_t i = 1; i < 10; ++i) sum = binary(Add, std::move(sum), k.ref(x[10 * half + i]));
    body.push_back(assign(k.ref(r[half]), std::move(sum)));
  }
  k.finish(std::move(body));
  split(module);
  const Plan& plan = module.kernels[0].plans.at(0);
  CHECK(plan.passes.size() == 2);
  CHECK(plan.stacks.empty());
  for (const Pass& pass : plan.passes) CHECK(pass.operands.size() == 11);
}

TEST_CASE("planes share a unit where no division helps") {
  Module module = testModule();
  KernelBuilder k(module, "many");
  std::vector<VarId> x;
  for (int i = 0; i < 20; ++i) x.push_back(k.input("x" + std::to_string(i), i < 3 ? intType : floatType));
  const VarId r = k.output("r", floatType);
  ExprPtr sum = k.ref(x[3]);
  for (std::size_t i = 4; i < 20; ++i) sum = binary(Add, std::move(sum), k.ref(x[i]));
  for (std::size_t i = 0; i < 3; ++i) {
    sum = binary(Add, std::move(sum), convert(Scalar::Float, k.ref(x[i])));
  }
  k.finish(block(assign(k.ref(r), std::move(sum))));
  split(module);
  const Plan& plan = module.kernels[0].plans.at(0);
  CHECK(plan.passes.size() == 1);
  REQUIRE(plan.stacks.size() == 1);
  CHECK(plan.stacks[0].type == floatType);
  CHECK(plan.stacks[0].layers.size() == 5);   // 20 planes, 5 of which share one unit
}

}  // namespace
}  // namespace skc::split
