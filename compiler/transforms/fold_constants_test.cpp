// SPDX-License-Identifier: MIT
//
// Promises: values are computed only if every device agrees; constants keep their names; dead branches go.
#include "transforms/passes.hpp"

#include <bit>
#include <functional>
#include <limits>
#include <optional>

#include <catch2/catch.hpp>

#include "ir/evaluate.hpp"
#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;
using enum BinaryOp;

/// The expression after folding, as text.
std::string folded(ExprPtr expr) {
  Module module = testModule();
  const Type type = expr->type;
  module.constants.push_back({"c", type, std::move(expr), {}});
  DiagnosticLog log;
  foldConstants(module, log);
  return print(module, Function{}, *module.constants[0].value);
}

std::string folded(BinaryOp op, ExprPtr a, ExprPtr b) {
  return folded(binary(op, std::move(a), std::move(b)));
}

TEST_CASE("floats are computed if all variants of a kernel have the same result") {
  CHECK(folded(Div, literal(1.0F), literal(4.0F)) == "0.25");
  CHECK(folded(Add, literal(2.0F), literal(0.5F)) == "2.5");
  CHECK(folded(Div, literal(1.0F), literal(3.0F)) == "1.0 / 3.0");
  CHECK(folded(Add, literal(16777216.0F), literal(1.0F)) == "16777216.0 + 1.0");
  CHECK(folded(Mul, literal(131072.0F), literal(0.125F)) == "131072.0 * 0.125");  // infinity in halves
  CHECK(folded(Mul, literal(0.1F, 0.1), literal(3.0F)) == "0.1 * 3.0");
  CHECK(folded(unary(UnaryOp::Negate, literal(0.1F, 0.1))) == "-0.1");
  CHECK(folded(Greater, literal(0.1F, 0.1), literal(0.0F)) == "true");
  CHECK(folded(Equal, literal(0.1F, 0.1), literal(0.1F)) == "0.1 == 0.1");
  CHECK(folded(Mul, literal(-0.0F), literal(2.0F)) == "-0.0");
  CHECK(folded(unary(UnaryOp::Negate, literal(0.0F))) == "-0.0");
  CHECK(folded(Less, literal(1.0F), literal(2.0F)) == "true");
}

TEST_CASE("in floats, every operation rounds to 32 bits") {
  const Module module = testModule();
  const auto value = [&](const ExprPtr& expr) {
    const auto bits = evaluateInFloat(module, *expr, Constants::Keep);
    return bits ? std::optional(std::bit_cast<float>(*bits)) : std::nullopt;
  };
  CHECK(value(binary(Div, literal(1.0F), literal(3.0F))) == 1.0F / 3);
  CHECK(value(binary(Add, literal(16777216.0F), literal(1.0F))) == 16777216.0F);
  CHECK(value(binary(Mul, literal(0.1F, 0.1), literal(3.0F))) == 0.1F * 3);
  CHECK(value(convert(Scalar::Float, literal(16777217))) == 16777216.0F);
  CHECK(value(convert(Scalar::Float, convert(Scalar::Half, binary(Div, literal(1.0F), literal(3.0F))))) ==
        0x1.554p-2F);
  CHECK(!value(binary(Mul, literal(1e30F), literal(1e30F))));
}

TEST_CASE("what devices may disagree about is left alone") {
  const float tiny = std::numeric_limits<float>::min();
  CHECK(folded(Div, literal(1.0F), literal(0.0F)) == "1.0 / 0.0");
  CHECK(folded(Mul, literal(1e30F), literal(1e30F)) == "1e+30 * 1e+30");
  CHECK(folded(Div, literal(tiny), literal(2.0F)).find(" / 2.0") != std::string::npos);
  CHECK(folded(Mul, literal(std::numeric_limits<float>::infinity()), literal(0.0F)) == "inf * 0.0");
  CHECK(folded(Div, literal(1), literal(0)) == "1 / 0");
  CHECK(folded(Rem, literal(1U), literal(0U)) == "1u % 0u");
  CHECK(folded(Div, literal(std::numeric_limits<std::int32_t>::min()), literal(-1)) == "-2147483648 / -1");
  CHECK(folded(ShiftLeft, literal(1), literal(32)) == "1 << 32");
  CHECK(folded(convert(Scalar::Int, literal(3e9F))) == "int(3e+09)");
  CHECK(folded(convert(Scalar::Uint, literal(-1.0F))) == "uint(-1.0)");
}

TEST_CASE("integers wrap") {
  CHECK(folded(Add, literal(std::numeric_limits<std::int32_t>::max()), literal(1)) == "-2147483648");
  CHECK(folded(Mul, literal(0x10000U), literal(0x10000U)) == "0u");
  CHECK(folded(ShiftRight, literal(-8), literal(1)) == "-4");
  CHECK(folded(ShiftRight, literal(0x80000000U), literal(31)) == "1u");
  CHECK(folded(Div, literal(-7), literal(2)) == "-3");
  CHECK(folded(Rem, literal(-7), literal(2)) == "-1");
  CHECK(folded(unary(UnaryOp::BitNot, literal(0))) == "-1");
}

TEST_CASE("conversions are C++'s") {
  CHECK(folded(convert(Scalar::Int, literal(-1.9F))) == "-1");
  CHECK(folded(convert(Scalar::Float, literal(2047))) == "2047.0");
  CHECK(folded(convert(Scalar::Float, literal(16777217))) == "float(16777217)");
  CHECK(folded(convert(Scalar::Bool, literal(0.5F))) == "true");
  CHECK(folded(convert(Scalar::Uint, literal(-1))) == "4294967295u");
}

TEST_CASE("an operand that decides ends && and ||; a neutral one goes") {
  const auto unknown = [] { return binary(Less, binary(Div, literal(1.0F), literal(0.0F)), literal(1.0F)); };
  CHECK(folded(LogicalAnd, literal(true), unknown()) == "1.0 / 0.0 < 1.0");
  CHECK(folded(LogicalAnd, unknown(), literal(false)) == "false");
  CHECK(folded(LogicalOr, literal(true), unknown()) == "true");
  CHECK(folded(LogicalOr, unknown(), literal(false)) == "1.0 / 0.0 < 1.0");
  CHECK(folded(select(literal(true), literal(2), literal(3))) == "2");
}

/// The body of a kernel with constants `periodic = false` and `n = 4`, after folding.
std::string body(const std::function<Block(Module&, KernelBuilder&)>& make) {
  Module module = testModule();
  module.constants.push_back({"periodic", Type::of(Scalar::Bool), literal(false), {}});
  module.constants.push_back({"n", intType, literal(4), {}});
  KernelBuilder k(module, "f");
  k.input("x", floatType);
  k.output("r", floatType);
  k.local("t", floatType);
  Block statements = make(module, k);
  k.finish(std::move(statements));
  DiagnosticLog log;
  foldConstants(module, log);
  REQUIRE(validate(module, Stage::Lowered) == "");
  const std::string text = print(module, module.functions[0]);
  return text.substr(text.find('{'));
}

TEST_CASE("names of constants stay in values and decide branches") {
  CHECK(body([](Module& m, KernelBuilder& k) {
          return block(assign(k.ref(1), convert(Scalar::Float, binary(Mul, constantRef(m, 1), literal(2)))));
        }) == "{\n  r = float(n * 2);\n}\n");
  CHECK(body([](Module& m, KernelBuilder& k) {
          return block(ifStmt(binary(LogicalAnd, constantRef(m, 0), binary(Less, k.ref(0), literal(1.0F))),
                              block(assign(k.ref(1), literal(1.0F))), block(assign(k.ref(1), k.ref(0)))));
        }) == "{\n  r = x;\n}\n");
  CHECK(body([](Module& m, KernelBuilder& k) {
          return block(
              assign(k.ref(1), select(binary(Less, constantRef(m, 1), literal(3)), k.ref(0), literal(0.0F))));
        }) == "{\n  r = 0.0;\n}\n");
}

TEST_CASE("components of vectors have names, where their numbers are known") {
  const Type float3 = Type::of(Scalar::Float, 3);
  CHECK(body([&](Module& m, KernelBuilder& k) {
          const VarId v = k.local("v", float3);
          return block(declare(v), assign(index(m, k.ref(v), literal(0U)), Add, k.ref(0)),
                       assign(index(m, k.ref(v), binary(Sub, constantRef(m, 1), literal(2))), k.ref(0)),
                       assign(index(m, k.ref(v), constantRef(m, 1)), k.ref(0)));
        }) == "{\n  float3 v;\n  v.x += x;\n  v.z = x;\n  v[n] = x;\n}\n");
}

TEST_CASE("a branch that declares something stays a scope") {
  CHECK(body([](Module&, KernelBuilder& k) {
          return block(ifStmt(literal(true), block(declare(2, k.ref(0)), assign(k.ref(1), k.ref(2)))));
        }) == "{\n  {\n    float t = x;\n    r = t;\n  }\n}\n");
}

TEST_CASE("a loop that never runs goes; one that runs once by `do` stays") {
  CHECK(body([](Module&, KernelBuilder& k) {
          return block(whileLoop(literal(false), block(assign(k.ref(1), literal(1.0F)))));
        }) == "{\n}\n");
  CHECK(body([](Module&, KernelBuilder& k) {
          return block(doWhileLoop(block(assign(k.ref(1), literal(1.0F))), literal(false)));
        }).find("do {") != std::string::npos);
}

TEST_CASE("a function that only a branch calls which is gone may stay, with its streams") {
  Module module = testModule();
  Function push;
  push.name = "push_b";
  const VarId value = addVariable(push, "x", floatType, VarRole::In);
  KernelBuilder k(module, "f");
  const VarId x = k.input("x", floatType), b = k.variableOutput("b", floatType);
  Block pushes = block(ir::push({StreamRef::Space::KernelParameter, b}, varRef(push, value)));
  const FunctionId helper = addFunction(module, std::move(push), std::move(pushes));
  k.finish(block(ifStmt(literal(false), block(callStmt(helper, exprs(k.ref(x)))))));
  DiagnosticLog log;
  REQUIRE(validate(module, Stage::Specialized) == "");
  foldConstants(module, log);
  CHECK(validate(module, Stage::Specialized) == "");
}

}  // namespace
}  // namespace skc
