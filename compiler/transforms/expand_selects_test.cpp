// SPDX-License-Identifier: MIT
//
// Promises: no `?:` chooses between structs or doubles afterwards, each side is evaluated only where it was, and other
// choices stay.
#include "transforms/expand_selects.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"

namespace skc {
namespace {

using namespace ir;

constexpr Type doubleType = Type::of(Scalar::Double);

/// A kernel of doubles a, b and a bool c, with an output r.
struct Sample {
  Module module = testModule();
  KernelBuilder k{module, "k"};
  VarId a = k.input("a", doubleType), b = k.input("b", doubleType);
  VarId c = k.uniform("c", Type::of(Scalar::Bool));
  VarId x = k.uniform("x", floatType);
  VarId r = k.output("r", doubleType);

  ExprPtr chosen() { return select(k.ref(c), k.ref(a), k.ref(b)); }
  ExprPtr isPositive(ExprPtr value) { return binary(BinaryOp::Greater, std::move(value), literal(0.0)); }

  std::string expanded(Block body) {
    k.finish(std::move(body));
    expandSelects(module);
    CHECK(validate(module, Stage::Lowered) == "");
    return print(module);
  }
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_CASE("a choice of doubles becomes a branch") {
  Sample s;
  const std::string text = s.expanded(block(assign(s.k.ref(s.r), s.chosen())));
  INFO(text);
  CHECK(has(
      text,
      "  double chosen;\n  if (c) {\n    chosen = a;\n  } else {\n    chosen = b;\n  }\n  r = chosen;\n"));
}

TEST_CASE("a chain of choices sets one variable") {
  Sample s;
  const std::string text = s.expanded(block(assign(
      s.k.ref(s.r), select(s.k.ref(s.c), s.k.ref(s.a), select(s.k.ref(s.c), s.k.ref(s.b), s.k.ref(s.a))))));
  INFO(text);
  CHECK_FALSE(has(text, "?"));
  CHECK(text.find("chosen: local") == text.rfind("chosen: local"));
}

TEST_CASE("a choice after && is evaluated where && would, and one in a loop's condition in every iteration") {
  Sample s;
  const std::string text = s.expanded(
      block(assign(s.k.ref(s.r), literal(0.0)),
            ifStmt(binary(BinaryOp::LogicalAnd, s.k.ref(s.c), s.isPositive(s.chosen())), block(returnStmt())),
            whileLoop(s.isPositive(s.chosen()), block(assign(s.k.ref(s.r), BinaryOp::Add, literal(1.0)))),
            doWhileLoop(block(continueStmt()), s.isPositive(s.chosen()))));
  INFO(text);
  CHECK_FALSE(has(text, "?"));
  CHECK_FALSE(has(text, "&&"));
  CHECK(has(text, "bool decided = c;\n  if (decided) {\n"));
  CHECK(has(text, "break;"));
  CHECK(has(text, "again = "));
}

TEST_CASE("choices of floats, and choices by component, stay") {
  Sample s;
  ExprPtr mask = construct(Type::of(Scalar::Bool, 2), exprs(s.k.ref(s.c), s.k.ref(s.c)));
  ExprPtr yes = construct(Type::of(Scalar::Double, 2), exprs(s.k.ref(s.a), s.k.ref(s.a)));
  ExprPtr no = clone(yes);
  ExprPtr pair = select(std::move(mask), std::move(yes), std::move(no));
  ExprPtr number = select(s.k.ref(s.c), s.k.ref(s.x), literal(1.0F));
  ExprPtr sum =
      binary(BinaryOp::Add, swizzle(std::move(pair), "x"), convert(Scalar::Double, std::move(number)));
  const std::string text = s.expanded(block(assign(s.k.ref(s.r), std::move(sum))));
  INFO(text);
  CHECK(has(text, "c ? x : 1.0"));
  CHECK_FALSE(has(text, "chosen"));
}

}  // namespace
}  // namespace skc
