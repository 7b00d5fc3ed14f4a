// SPDX-License-Identifier: MIT
//
// Promise: the dump shows the whole module, C-like, with no more brackets than needed.
#include "ir/print.hpp"

#include <limits>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"

namespace skc::ir {
namespace {

std::string text(const ExprPtr& expr) { return print(testModule(), Function{}, *expr); }
ExprPtr op(BinaryOp o, ExprPtr a, ExprPtr b) { return binary(o, std::move(a), std::move(b)); }

TEST_CASE("brackets stand only where the tree needs them, or where people would doubt") {
  using enum BinaryOp;
  const auto one = [] { return literal(1); };
  CHECK(text(op(Add, op(Mul, one(), one()), one())) == "1 * 1 + 1");
  CHECK(text(op(Mul, op(Add, one(), one()), one())) == "(1 + 1) * 1");
  CHECK(text(op(Sub, one(), op(Sub, one(), one()))) == "1 - (1 - 1)");
  CHECK(text(op(Sub, op(Sub, one(), one()), one())) == "1 - 1 - 1");
  CHECK(text(op(ShiftLeft, one(), op(Add, one(), one()))) == "1 << (1 + 1)");
  CHECK(text(unary(UnaryOp::Negate, op(Add, one(), one()))) == "-(1 + 1)");
  CHECK(text(select(literal(true), one(), select(literal(false), one(), one()))) ==
        "true ? 1 : false ? 1 : 1");
}

TEST_CASE("special floats have names") {
  CHECK(text(literal(std::numeric_limits<float>::infinity())) == "inf");
  CHECK(text(literal(-std::numeric_limits<float>::infinity())) == "-inf");
  CHECK(text(literal(std::numeric_limits<float>::quiet_NaN())) == "nan");
}

TEST_CASE("a kernel is shown with its parameters and its function") {
  Module module = testModule();
  KernelBuilder k(module, "axpy");
  k.kernel().scope = {"blas"};
  const VarId a = k.uniform("a", floatType);
  const VarId u = k.gather("u", floatType, 2, Boundary::Border, literal(0.5F));
  const VarId r = k.output("r", floatType);
  const VarId i = k.local("i", intType);
  const Type int2 = Type::of(Scalar::Int, 2);
  ExprPtr index = construct(int2, exprs(k.ref(i), literal(0)));
  ExprPtr value =
      binary(BinaryOp::Mul, k.ref(a), gatherRead(floatType, KernelBuilder::stream(u), std::move(index)));
  Block body = block(assign(k.ref(r), BinaryOp::Add, std::move(value)));
  k.finish(block(forLoop(block(declare(i, literal(0))), binary(BinaryOp::Less, k.ref(i), literal(3)),
                         block(assign(k.ref(i), BinaryOp::Add, literal(1))), std::move(body))));
  CHECK(print(module) == R"(module test.sk

kernel blas::axpy: entry @0
  $0 a: uniform float
  $1 u: gather float rank 2 border(0.5)
  $2 r: output float

function @0 axpy -> void
  a: in float
  u: gather float rank 2
  r: inout float
  i: local int
{
  for (int i = 0; i < 3; i += 1) {
    r += a * u[int2{i, 0}];
  }
}

)");
}

TEST_CASE("variables of one name are told apart") {
  Module module = testModule();
  KernelBuilder k(module, "f");
  const VarId r = k.output("r", floatType);
  const VarId a = k.local("a", floatType);
  const VarId b = k.local("a", floatType);
  k.finish(block(declare(a, literal(1.0F)), scope(block(declare(b, k.ref(a)), assign(k.ref(r), k.ref(b))))));
  const std::string all = print(module);
  CHECK(all.find("float a#2 = a#1;") != std::string::npos);
}

}  // namespace
}  // namespace skc::ir
