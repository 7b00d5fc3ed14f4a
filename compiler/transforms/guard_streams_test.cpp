// SPDX-License-Identifier: MIT
//
// Promises: a stream's condition is the one under which some use of it runs, as far as branches on spec
// parameters decide that; what cannot be analysed counts as a use.
#include "transforms/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;

constexpr Type boolType = Type::of(Scalar::Bool);

/// A kernel with a flag, a number, two inputs and an output; each case builds its own body.
struct GuardedKernel {
  Module module = testModule();
  KernelBuilder k{module, "f"};
  VarId flag = k.spec("flag", boolType);
  VarId n = k.spec("n", intType);
  VarId x = k.input("x", floatType);
  VarId y = k.input("y", floatType);
  VarId r = k.output("r", floatType);

  Stmt write(ExprPtr value) { return assign(k.ref(r), std::move(value)); }
  ExprPtr isN(int value) { return binary(BinaryOp::Equal, k.ref(n), literal(value)); }

  /// "condition of y", or "always".
  std::string need(Block body) {
    const KernelId id = k.finish(std::move(body));
    DiagnosticLog log;
    guardStreams(module, log);
    CHECK(validate(module, Stage::Specialized).empty());
    const Kernel& kernel = module.kernels[id];
    CHECK(kernel.params[r].neededIf == nullptr);
    const ExprPtr& need = kernel.params[y].neededIf;
    return need ? print(module, module.functions[kernel.entry], *need) : "always";
  }
};

TEST_CASE("branches, selections and short circuits guard") {
  GuardedKernel a, b, c, d;
  CHECK(a.need(block(a.write(a.k.ref(a.x)), ifStmt(a.k.ref(a.flag), block(a.write(a.k.ref(a.y)))))) ==
        "flag");
  CHECK(b.need(block(b.write(select(b.k.ref(b.flag), b.k.ref(b.x), b.k.ref(b.y))))) == "!flag");
  const auto isPositive = [](GuardedKernel& s) {
    return binary(BinaryOp::Greater, s.k.ref(s.y), literal(0.0F));
  };
  CHECK(c.need(block(ifStmt(binary(BinaryOp::LogicalAnd, c.k.ref(c.flag), isPositive(c)),
                            block(c.write(c.k.ref(c.x))), block(c.write(literal(0.0F)))))) == "flag");
  CHECK(d.need(block(ifStmt(binary(BinaryOp::LogicalOr, d.isN(3), isPositive(d)),
                            block(d.write(d.k.ref(d.x))), block(d.write(literal(0.0F)))))) == "!(n == 3)");
}

TEST_CASE("a condition may join others") {
  GuardedKernel a, b;
  const auto need = [](GuardedKernel& s, BinaryOp op) {
    return s.need(block(s.write(s.k.ref(s.x)),
                        ifStmt(binary(op, s.k.ref(s.flag), s.isN(2)), block(s.write(s.k.ref(s.y))))));
  };
  CHECK(need(a, BinaryOp::LogicalOr) == "flag || n == 2");
  CHECK(need(b, BinaryOp::LogicalAnd) == "flag && n == 2");
}

TEST_CASE("several uses need the stream where any of them runs, nested guards where all hold") {
  GuardedKernel a, b;
  CHECK(a.need(block(a.write(literal(0.0F)), ifStmt(a.k.ref(a.flag), block(a.write(a.k.ref(a.y)))),
                     ifStmt(a.isN(2), block(a.write(a.k.ref(a.y)))),
                     ifStmt(a.isN(2), block(a.write(a.k.ref(a.y)))))) == "flag || n == 2");
  CHECK(b.need(block(b.write(literal(0.0F)),
                     ifStmt(b.k.ref(b.flag), block(ifStmt(b.isN(2), block(b.write(b.k.ref(b.y)))))))) ==
        "flag && n == 2");
}

TEST_CASE("what leaves early guards what follows") {
  GuardedKernel s;
  CHECK(s.need(block(s.write(s.k.ref(s.x)),
                     ifStmt(unary(UnaryOp::LogicalNot, s.k.ref(s.flag)), block(returnStmt())),
                     s.write(s.k.ref(s.y)))) == "flag");
}

TEST_CASE("a switch guards by its labels, fall-through included") {
  GuardedKernel s;
  std::vector<Case> cases;
  cases.push_back({{0}, false, block(s.write(s.k.ref(s.x)), breakStmt()), {}});
  cases.push_back({{1}, false, block(s.write(literal(1.0F))), {}});
  cases.push_back({{2}, false, block(s.write(s.k.ref(s.y)), breakStmt()), {}});
  cases.push_back({{}, true, block(s.write(literal(0.0F)), breakStmt()), {}});
  CHECK(s.need(block(switchStmt(s.k.ref(s.n), std::move(cases)))) == "n == 2 || n == 1");
}

TEST_CASE("locals and parameters of functions are looked through unless they change") {
  const auto need = [](bool changes) {
    GuardedKernel s;
    Function f;
    f.name = "pick";
    f.result = floatType;
    const VarId which = addVariable(f, "which", boolType, VarRole::In);
    const VarId a = addVariable(f, "a", floatType, VarRole::In);
    ExprPtr condition = varRef(f, which);
    ExprPtr value = varRef(f, a);
    const FunctionId pick =
        addFunction(s.module, std::move(f),
                    block(returnStmt(select(std::move(condition), std::move(value), literal(0.0F)))));
    const VarId deep = s.k.local("deep", boolType);
    Block body = block(declare(deep, binary(BinaryOp::Less, s.k.ref(s.n), literal(5))));
    if (changes) body.push_back(assign(s.k.ref(deep), literal(true)));
    body.push_back(s.write(s.k.ref(s.x)));
    body.push_back(
        ifStmt(s.k.ref(deep), block(s.write(call(s.module, pick, exprs(s.k.ref(s.flag), s.k.ref(s.y)))))));
    return s.need(std::move(body));
  };
  CHECK(need(false) == "n < 5");
  CHECK(need(true) == "always");
}

/// A function of two parameters, `flag` and `n`.
struct Chooser {
  explicit Chooser(Type result) {
    f.name = "choose";
    f.result = result;
    flag = addVariable(f, "flag", boolType, VarRole::In);
    n = addVariable(f, "n", intType, VarRole::In);
    f.parameterCount = 2;
  }
  Function f;
  VarId flag, n;

  ExprPtr isN(int value) { return binary(BinaryOp::Equal, varRef(f, n), literal(value)); }
  /// The condition of a stream that is read if the kernel's flag and number make the function's result true, or 5.
  std::string need(Block body) {
    GuardedKernel s;
    const bool isBool = f.result.isBool();
    const FunctionId id = addFunction(s.module, std::move(f), std::move(body));
    ExprPtr result = call(s.module, id, exprs(s.k.ref(s.flag), s.k.ref(s.n)));
    ExprPtr isWanted = isBool ? std::move(result) : binary(BinaryOp::Equal, std::move(result), literal(5));
    return s.need(block(s.write(s.k.ref(s.x)), ifStmt(std::move(isWanted), block(s.write(s.k.ref(s.y))))));
  }
};

TEST_CASE("what functions return is looked through") {
  Chooser formula(boolType), early(boolType), nested(boolType), number(intType), selected(intType);
  CHECK(formula.need(block(returnStmt(binary(BinaryOp::LogicalAnd, varRef(formula.f, formula.flag),
                                             formula.isN(3))))) == "flag && n == 3");
  CHECK(early.need(block(ifStmt(varRef(early.f, early.flag), block(returnStmt(literal(false)))),
                         returnStmt(early.isN(3)))) == "!flag && n == 3");
  Block inner = block(ifStmt(nested.isN(1), block(returnStmt(literal(true)))));
  CHECK(nested.need(block(ifStmt(varRef(nested.f, nested.flag), std::move(inner)),
                          returnStmt(nested.isN(2)))) == "(flag && n == 1) || n == 2");
  CHECK(number.need(block(ifStmt(varRef(number.f, number.flag), block(returnStmt(literal(5))),
                                 block(returnStmt(varRef(number.f, number.n)))))) == "flag || n == 5");
  CHECK(selected.need(block(returnStmt(select(varRef(selected.f, selected.flag), literal(5), literal(4))))) ==
        "flag");
}

TEST_CASE("what functions return by a switch is looked through, unless it may leave a case in between") {
  for (const bool isLeft : {false, true}) {
    Chooser s(boolType);
    Block first =
        block(ifStmt(varRef(s.f, s.flag), isLeft ? block(breakStmt()) : block(returnStmt(literal(true)))));
    first.push_back(returnStmt(literal(false)));
    std::vector<Case> cases;
    cases.push_back({{1}, false, {}, {}});
    cases.push_back({{2}, false, std::move(first), {}});
    cases.push_back({{3}, false, block(breakStmt()), {}});
    cases.push_back({{}, true, block(returnStmt(literal(false))), {}});
    const std::string need =
        s.need(block(switchStmt(varRef(s.f, s.n), std::move(cases)), returnStmt(literal(true))));
    CHECK(need ==
          (isLeft ? "always"
                  : "((n == 2 || n == 1) && flag) || (!(n == 2 || n == 1) && (n == 1 || n == 2 || n == 3))"));
  }
}

TEST_CASE("a result that depends on more than spec parameters is unknown") {
  Chooser changed(boolType), looped(boolType);
  Block body = block(assign(varRef(changed.f, changed.flag), literal(true)));
  body.push_back(returnStmt(varRef(changed.f, changed.flag)));
  CHECK(changed.need(std::move(body)) == "always");
  Block inner = block(returnStmt(varRef(looped.f, looped.flag)));
  CHECK(looped.need(block(whileLoop(looped.isN(1), std::move(inner)), returnStmt(literal(false)))) ==
        "always");
}

TEST_CASE("gathers in functions are needed as the calls are guarded") {
  GuardedKernel s;
  const VarId u = s.k.gather("u", floatType, 1);
  Function f;
  f.name = "read";
  f.result = floatType;
  const VarId which = addVariable(f, "which", boolType, VarRole::In);
  const StreamRef stream{StreamRef::Space::KernelParameter, u};
  ExprPtr read = select(varRef(f, which), gatherRead(floatType, stream, literal(0)), literal(0.0F));
  const FunctionId id = addFunction(s.module, std::move(f), block(returnStmt(std::move(read))));
  const KernelId kernel = s.k.finish(
      block(s.write(binary(BinaryOp::Add, call(s.module, id, exprs(s.k.ref(s.flag))), s.k.ref(s.y)))));
  DiagnosticLog log;
  guardStreams(s.module, log);
  const Kernel& made = s.module.kernels[kernel];
  REQUIRE(made.params[u].neededIf);
  CHECK(print(s.module, s.module.functions[made.entry], *made.params[u].neededIf) == "flag");
  CHECK_FALSE(made.params[s.y].neededIf);
}

}  // namespace
}  // namespace skc
