// SPDX-License-Identifier: MIT
//
// Promises: part of a row at a computed index is written with its whole row; everything else stays.
#include "transforms/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;

constexpr Type matrix = Type::matrix(2);
constexpr Type row = Type::of(Scalar::Float, 2);

/// A kernel with a matrix `r` and an index `i`, and a function `grow` that changes a float.
struct Sample {
  Module module = testModule();
  FunctionId grow;
  KernelBuilder builder;
  VarId i, r;

  Sample()
      : grow(addGrow(module)),
        builder(module, "k"),
        i(builder.input("i", intType)),
        r(builder.output("r", matrix)) {}

  static FunctionId addGrow(Module& module) {
    Function function;
    function.name = "grow";
    const VarId x = addVariable(function, "x", floatType, VarRole::InOut);
    Block body = block(assign(varRef(function, x), BinaryOp::Add, literal(1.0F)));
    return addFunction(module, std::move(function), std::move(body));
  }

  ExprPtr at(ExprPtr number) { return index(module, builder.ref(r), std::move(number)); }
  ExprPtr zero() {
    return construct(matrix,
                     exprs(construct(row, exprs(literal(0.0F))), construct(row, exprs(literal(0.0F)))));
  }

  /// The statements after the transform, as text without indentation.
  std::string rewritten(Stmt stmt) {
    builder.finish(block(assign(builder.ref(r), zero()), std::move(stmt)));
    DiagnosticLog log;
    assignRows(module, log);
    CHECK(validate(module, Stage::Lowered) == "");
    return print(module);
  }
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_CASE("a component of a computed row is written with the row") {
  Sample s;
  const std::string text = s.rewritten(assign(swizzle(s.at(s.builder.ref(s.i)), "x"), literal(1.0F)));
  INFO(text);
  CHECK(has(text, "r_index"));
  CHECK(has(text, "r_row"));
  CHECK_FALSE(has(text, "].x ="));
}

TEST_CASE("a component that a function changes is written back") {
  Sample s;
  const std::string text = s.rewritten(callStmt(s.grow, exprs(swizzle(s.at(s.builder.ref(s.i)), "y"))));
  INFO(text);
  CHECK(has(text, "r_row"));
  CHECK_FALSE(has(text, "].y"));
}

TEST_CASE("a component of a known row of a matrix at a computed index is written with the row") {
  Sample s;
  const VarId many = s.builder.local("many", arrayOf(s.module, matrix, 3));
  const auto at = [&](ExprPtr number) {
    return swizzle(index(s.module, index(s.module, s.builder.ref(many), std::move(number)), literal(1)), "x");
  };
  const std::string text = s.rewritten(scope(block(
      declare(many), assign(at(s.builder.ref(s.i)), literal(1.0F)), assign(at(literal(2)), literal(1.0F)))));
  INFO(text);
  CHECK(has(text, "many_row.x = 1.0"));
  CHECK(has(text, "many[i][1] = many_row"));
  CHECK(has(text, "many[2][1].x = 1.0"));
  CHECK_FALSE(has(text, "many_index"));
}

TEST_CASE("whole rows and rows that are known stay") {
  Sample whole;
  ExprPtr value = construct(row, exprs(literal(1.0F)));
  CHECK_FALSE(has(whole.rewritten(assign(whole.at(whole.builder.ref(whole.i)), std::move(value))), "r_row"));
  Sample known;
  CHECK_FALSE(has(known.rewritten(assign(swizzle(known.at(literal(1)), "x"), literal(1.0F))), "r_row"));
}

}  // namespace
}  // namespace skc
