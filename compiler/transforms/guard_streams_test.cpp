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
