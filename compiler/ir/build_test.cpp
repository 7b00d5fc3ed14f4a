// SPDX-License-Identifier: MIT
//
// Promises: constructors derive types as C++ and GLSL do, a clone is equal and independent, the walk
// reaches every node, and a component is extracted from constructors, swizzles and operators.
#include "ir/build.hpp"

#include <bit>
#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "ir/evaluate.hpp"
#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/walk.hpp"

namespace skc::ir {
namespace {

TEST_CASE("a float literal keeps the double of its text") {
  for (const double text :
       {0.1, -0.1, 1.0 / 3.0, 1e30, -1e-30, 16777217.0, 4294967295.0, 0x1.fffffffffffffp-1,
        0x1.0000010000001p0, 0x1.fffffefffffffp5, 0.0, 2.5, 1e-300, -1e-42, 0x1.2345p-140, 3.5e38}) {
    const ExprPtr expr = literal(static_cast<float>(text), text);
    const auto& n = std::get<Literal>(expr->node);
    CHECK(wideValue(n) == text);
    CHECK(std::bit_cast<float>(n.bits) == static_cast<float>(text));
    CHECK(wideValue(Literal{n.bits ^ 0x80000000U, 0, n.text}) == -text);
  }
  CHECK(wideValue(std::get<Literal>(literal(0.1F)->node)) == double{0.1F});
  const ExprPtr beyond = literal(std::numeric_limits<float>::infinity(), 1e300);
  CHECK(wideValue(std::get<Literal>(beyond->node)) == 1e300);
}

TEST_CASE("types follow from operands") {
  const Type float3 = Type::of(Scalar::Float, 3);
  const auto vector = [&] { return literalOf(float3, 1); };
  CHECK(binary(BinaryOp::Mul, literal(2.0F), vector())->type == float3);
  CHECK(binary(BinaryOp::Mul, vector(), literal(2.0F))->type == float3);
  CHECK(binary(BinaryOp::Less, vector(), vector())->type == Type::of(Scalar::Bool, 3));
  CHECK(binary(BinaryOp::Equal, literal(1), literal(1))->type == Type::of(Scalar::Bool));
  CHECK(binary(BinaryOp::ShiftLeft, literal(1), literal(1U))->type == intType);
  CHECK(swizzle(vector(), "zx")->type == Type::of(Scalar::Float, 2));
  CHECK(swizzle(vector(), "r")->type == floatType);
  CHECK(convert(Scalar::Int, vector())->type == Type::of(Scalar::Int, 3));
  CHECK(intrinsic(Intrinsic::Dot, exprs(vector(), vector()))->type == floatType);
}

TEST_CASE("converting to the same component type is nothing") {
  ExprPtr value = literal(1.0F);
  const Expr* before = value.get();
  CHECK(convert(Scalar::Float, std::move(value)).get() == before);
}

TEST_CASE("arrays are entered once") {
  Module module = testModule();
  CHECK(arrayOf(module, floatType, 5) == arrayOf(module, floatType, 5));
  CHECK(arrayOf(module, floatType, 6) != arrayOf(module, floatType, 5));
  CHECK(module.arrays.size() == 2);
}

/// A module with every kind of statement and most kinds of expressions.
Module everything() {
  Module module = testModule();
  KernelBuilder k(module, "all");
  const VarId u = k.gather("u", floatType, 1);
  const VarId x = k.input("x", floatType);
  const VarId r = k.output("r", floatType);
  const VarId i = k.local("i", intType);
  const VarId s = k.local("s", floatType);
  Block loopBody =
      block(ifStmt(binary(BinaryOp::Less, k.ref(i), literal(2)), block(continueStmt()), block(breakStmt())),
            assign(k.ref(s), BinaryOp::Add, gatherRead(floatType, KernelBuilder::stream(u), k.ref(i))));
  std::vector<Case> cases;
  cases.push_back({{1, 2}, false, block(breakStmt()), {}});
  cases.push_back({{}, true, block(scope(block(assign(k.ref(s), unary(UnaryOp::Negate, k.ref(x)))))), {}});
  k.finish(block(
      declare(s, intrinsic(Intrinsic::Sin, exprs(k.ref(x)))),
      forLoop(block(declare(i, literal(0))), binary(BinaryOp::Less, k.ref(i), literal(9)),
              block(assign(k.ref(i), BinaryOp::Add, literal(1))), std::move(loopBody)),
      whileLoop(literal(false),
                block(assign(k.ref(s), neighborRead(floatType, KernelBuilder::stream(u), literal(1))))),
      doWhileLoop(
          block(assign(k.ref(s), convert(Scalar::Float, swizzle(indexOf(KernelBuilder::stream(x)), "x")))),
          literal(false)),
      switchStmt(swizzle(extentOf(KernelBuilder::stream(u)), "x"), std::move(cases)),
      assign(k.ref(r), select(literal(true), k.ref(s), k.ref(x))), returnStmt()));
  return module;
}

TEST_CASE("a clone prints the same and shares nothing") {
  Module module = everything();
  const std::string before = print(module);
  Function copy = clone(module.functions[0]);
  walkExprs(module.functions[0].body, [](Expr& expr) {
    if (auto* n = std::get_if<Literal>(&expr.node)) n->bits = 1;
  });
  CHECK(print(module) != before);
  module.functions[0] = std::move(copy);
  CHECK(print(module) == before);
}

TEST_CASE("the walk reaches every expression and statement") {
  Module module = everything();
  int literals = 0;
  int statements = 0;
  const Block& body = module.functions[0].body;
  walkExprs(body, [&](const Expr& expr) { literals += std::holds_alternative<Literal>(expr.node) ? 1 : 0; });
  walkStmts(body, [&](const Stmt&) { ++statements; });
  CHECK(literals == 8);
  CHECK(statements == 18);
}

TEST_CASE("rewriting goes from the inside to the outside") {
  Module module = testModule();
  ExprPtr sum = binary(BinaryOp::Add, binary(BinaryOp::Mul, literal(2), literal(3)), literal(4));
  rewriteExprs(sum, [&](ExprPtr& slot) {
    if (const auto bits = evaluate(module, *slot, Constants::Keep))
      slot = literal(static_cast<std::int32_t>(*bits));
  });
  CHECK(std::get<Literal>(sum->node).bits == 10);
}

TEST_CASE("a clone of a module is equal and separate") {
  const Module module = everything();
  const std::string text = print(module);
  Module copy = clone(module);
  CHECK(print(copy) == text);
  copy.functions[0].body.clear();
  copy.kernels.clear();
  CHECK(print(module) == text);
}

const Type int2 = Type::of(Scalar::Int, 2), int3 = Type::of(Scalar::Int, 3);

/// Component `number` of the expression that `make` builds from variables `v`, an int2, and `s`, an int.
template <class Make>
std::string component(Make make, std::uint8_t number) {
  Module module = testModule();
  Function function;
  const VarId v = addVariable(function, "v", int2), s = addVariable(function, "s", intType);
  const ExprPtr vector = make(function, v, s);
  return print(module, function, *componentOf(*vector, number));
}

TEST_CASE("components come out of constructors and swizzles") {
  const auto whole = [](const Function& f, VarId v, VarId s) {
    return construct(int3, exprs(varRef(f, v), varRef(f, s)));
  };
  CHECK(component(whole, 0) == "v.x");
  CHECK(component(whole, 1) == "v.y");
  CHECK(component(whole, 2) == "s");
  const auto splat = [](const Function& f, VarId, VarId s) { return construct(int2, exprs(varRef(f, s))); };
  CHECK(component(splat, 1) == "s");
  const auto turned = [](const Function& f, VarId v, VarId) { return swizzle(varRef(f, v), "yx"); };
  CHECK(component(turned, 0) == "v.y");
}

TEST_CASE("operators by component, also of a vector and a scalar") {
  const auto product = [](const Function& f, VarId v, VarId s) {
    return binary(BinaryOp::Mul, varRef(f, s), unary(UnaryOp::Negate, varRef(f, v)));
  };
  CHECK(component(product, 1) == "s * -v.y");
  const auto converted = [](const Function& f, VarId v, VarId) {
    return convert(Scalar::Float, varRef(f, v));
  };
  CHECK(component(converted, 0) == "float(v.x)");
}

TEST_CASE("a matrix times a vector is not taken apart") {
  const auto product = [](const Function& f, VarId v, VarId) {
    return binary(BinaryOp::Mul, construct(Type::matrix(2), exprs(literal(1.0F))),
                  convert(Scalar::Float, varRef(f, v)));
  };
  CHECK(component(product, 1).ends_with(".y"));
}

}  // namespace
}  // namespace skc::ir
