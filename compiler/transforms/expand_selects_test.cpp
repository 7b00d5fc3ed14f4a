// SPDX-License-Identifier: MIT
//
// Promises: no `?:` chooses between structs or doubles afterwards, each side is evaluated only where it was, and other
// choices stay.
#include "transforms/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"

namespace skc {
namespace {

using namespace ir;

constexpr Type doubleType = Type::of(Scalar::Double);

/// A kernel of doubles a, b and a bool c, with an output r.
struct ChoiceKernel {
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

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("a choice of doubles becomes a branch") {
  ChoiceKernel s;
  const std::string text = s.expanded(block(assign(s.k.ref(s.r), s.chosen())));
  INFO(text);
  CHECK(contains(
      text,
      "  double chosen;\n  if (c) {\n    chosen = a;\n  } else {\n    chosen = b;\n  }\n  r = chosen;\n"));
}

TEST_CASE("a chain of choices sets one variable") {
  ChoiceKernel s;
  const std::string text = s.expanded(block(assign(
      s.k.ref(s.r), select(s.k.ref(s.c), s.k.ref(s.a), select(s.k.ref(s.c), s.k.ref(s.b), s.k.ref(s.a))))));
  INFO(text);
  CHECK_FALSE(contains(text, "?"));
  CHECK(text.find("chosen: local") == text.rfind("chosen: local"));
}

TEST_CASE("a choice after && is evaluated where && would, and one in a loop's condition in every iteration") {
  ChoiceKernel s;
  const std::string text = s.expanded(
      block(assign(s.k.ref(s.r), literal(0.0)),
            ifStmt(binary(BinaryOp::LogicalAnd, s.k.ref(s.c), s.isPositive(s.chosen())), block(returnStmt())),
            whileLoop(s.isPositive(s.chosen()), block(assign(s.k.ref(s.r), BinaryOp::Add, literal(1.0)))),
            doWhileLoop(block(continueStmt()), s.isPositive(s.chosen()))));
  INFO(text);
  CHECK_FALSE(contains(text, "?"));
  CHECK_FALSE(contains(text, "&&"));
  CHECK(contains(text, "bool decided = c;\n  if (decided) {\n"));
  CHECK(contains(text, "break;"));
  CHECK(contains(text, "again = "));
}

TEST_CASE("choices of floats, and choices by component, stay") {
  ChoiceKernel s;
  ExprPtr mask = construct(Type::of(Scalar::Bool, 2), exprs(s.k.ref(s.c), s.k.ref(s.c)));
  ExprPtr yes = construct(Type::of(Scalar::Double, 2), exprs(s.k.ref(s.a), s.k.ref(s.a)));
  ExprPtr no = clone(yes);
  ExprPtr pair = select(std::move(mask), std::move(yes), std::move(no));
  ExprPtr number = select(s.k.ref(s.c), s.k.ref(s.x), literal(1.0F));
  ExprPtr sum =
      binary(BinaryOp::Add, swizzle(std::move(pair), "x"), convert(Scalar::Double, std::move(number)));
  const std::string text = s.expanded(block(assign(s.k.ref(s.r), std::move(sum))));
  INFO(text);
  CHECK(contains(text, "c ? x : 1.0"));
  CHECK_FALSE(contains(text, "chosen"));
}

}  // namespace
}  // namespace skc
