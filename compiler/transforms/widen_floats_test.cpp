// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;

/// r = a + t * g[0]
KernelId addBlend(Module& module) {
  KernelBuilder builder(module, "blend");
  const VarId t = builder.uniform("t", floatType);
  const VarId a = builder.input("a", floatType);
  const VarId g = builder.gather("g", floatType, 1, Boundary::Border, literal(0.5F));
  const VarId r = builder.output("r", floatType);
  ExprPtr read = gatherRead(floatType, {StreamRef::Space::KernelParameter, g}, literal(0));
  ExprPtr sum = binary(BinaryOp::Add, builder.ref(a), binary(BinaryOp::Mul, builder.ref(t), std::move(read)));
  return builder.finish(block(assign(builder.ref(r), std::move(sum))));
}

std::string entryOf(const Module& module, KernelId id) {
  const std::string text = print(module);
  const std::string head = "function @" + std::to_string(module.kernels[id].entry) + " ";
  return text.substr(text.find(head));
}

TEST_CASE("a wide form computes in doubles and holds floats") {
  Module module = testModule();
  const KernelId id = addBlend(module);
  DiagnosticLog log;
  widenFloats(module, log);
  REQUIRE(module.kernels[id].variants.wide);
  const Kernel& wide = module.kernels[*module.kernels[id].variants.wide];
  CHECK(wide.params[0].type == floatType);
  CHECK(wide.params[1].type == Type::of(Scalar::Double));
  CHECK(wide.params[1].held == floatType);
  CHECK(wide.params[2].border->type == Type::of(Scalar::Double));
  CHECK(validate(module, Stage::Specialized).empty());
  const std::string text = entryOf(module, *module.kernels[id].variants.wide);
  INFO(text);
  CHECK(text.find("t_wide") != std::string::npos);
}

TEST_CASE("a wide form has the literals of the text, also where a float is infinity or 0") {
  Module module = testModule();
  KernelBuilder builder(module, "scaled");
  const VarId a = builder.input("a", floatType);
  const VarId r = builder.output("r", floatType);
  const auto times = [](ExprPtr from, float value, double text) {
    return binary(BinaryOp::Mul, std::move(from), literal(value, text));
  };
  constexpr float infinity = std::numeric_limits<float>::infinity();
  ExprPtr scaled = times(times(times(builder.ref(a), infinity, 1e300), 0.0F, 1e-300), -0.1F, -0.1);
  const KernelId id = builder.finish(block(assign(builder.ref(r), std::move(scaled))));
  DiagnosticLog log;
  widenFloats(module, log);
  REQUIRE(module.kernels[id].variants.wide);
  const std::string text = entryOf(module, *module.kernels[id].variants.wide);
  INFO(text);
  CHECK(text.find("1e+300d") != std::string::npos);
  CHECK(text.find("1e-300d") != std::string::npos);
  CHECK(text.find("-0.1d") != std::string::npos);
}

TEST_CASE("what doubles cannot do has no wide form, and says why") {
  Module module = testModule();
  KernelBuilder builder(module, "turned", 7);
  const VarId m = builder.uniform("m", Type::matrix(2));
  const VarId r = builder.output("r", floatType);
  ExprPtr determinant = intrinsic(Intrinsic::Determinant, exprs(builder.ref(m)), atLine(8));
  const KernelId id = builder.finish(block(assign(builder.ref(r), std::move(determinant))));
  DiagnosticLog log;
  widenFloats(module, log);
  CHECK_FALSE(module.kernels[id].variants.wide);
  CHECK(module.kernels[id].variants.whyNotWide == "matrices are of floats (test.sk:7)");
}

TEST_CASE("a half form rounds what is read and what is computed, once") {
  Module module = testModule();
  const KernelId id = addBlend(module);
  DiagnosticLog log;
  roundHalves(module, log);
  REQUIRE(module.kernels[id].variants.half);
  CHECK(validate(module, Stage::Specialized).empty());
  const std::string text = entryOf(module, *module.kernels[id].variants.half);
  INFO(text);
  std::size_t roundings = 0;
  for (std::size_t at = text.find("half("); at != std::string::npos; at = text.find("half(", at + 1))
    ++roundings;
  CHECK(roundings == 5);   // t, a, g[0], the product, the sum
}

}  // namespace
}  // namespace skc
