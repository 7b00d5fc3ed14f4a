// SPDX-License-Identifier: MIT
//
// Promises: a slice keeps what its variables need, with the control flow around it, and nothing else; a
// loaded variable removes the statements that compute it, unless something reads it before it is final.
#include "split/slice.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"

namespace skc::split {
namespace {

using namespace ir;
using enum BinaryOp;

/// A body to slice, with float s and t, outputs a and b, an input x and an int n.
struct Sample {
  Module module = testModule();
  KernelBuilder k{module, "sample"};
  VarId x = k.input("x", floatType), n = k.input("n", intType);
  VarId a = k.output("a", floatType), b = k.output("b", floatType);
  VarId s = k.local("s", floatType), t = k.local("t", floatType), i = k.local("i", intType);

  ExprPtr ref(VarId var) const { return k.ref(var); }
  Stmt add(VarId var, ExprPtr value) const { return assign(ref(var), Add, std::move(value)); }
  Stmt set(VarId var, ExprPtr value) const { return assign(ref(var), std::move(value)); }
  Stmt count(Block body) const {
    return forLoop(block(declare(i, literal(0))), binary(Less, ref(i), ref(n)), block(add(i, literal(1))),
                   std::move(body));
  }

  void finish(Block body) { k.finish(std::move(body)); }

  /// Prints the slice for some variables.
  std::string slice(std::initializer_list<VarId> wanted, std::initializer_list<VarId> loadable = {}) const {
    const Function& entry = module.functions[0];
    const auto set = [&](std::initializer_list<VarId> list) {
      VarSet made(entry.variables.size(), false);
      for (VarId var : list) made[var] = true;
      return made;
    };
    const Slicer slicer(module, entry);
    const Slice slice = slicer.slice(set(wanted), set(loadable));
    Function kept = clone(entry);
    kept.body = slicer.copy(slice);
    const std::string text = print(module, kept);
    return text.substr(text.find('{'));
  }
};

TEST_CASE("what only others need is left out") {
  Sample q;
  q.finish(block(declare(q.s, q.ref(q.x)), declare(q.t, literal(1.0f)),
                 q.count(block(q.add(q.s, q.ref(q.x)), assign(q.ref(q.t), Mul, q.ref(q.x)))),
                 q.set(q.a, q.ref(q.s)), q.set(q.b, q.ref(q.t))));
  CHECK(q.slice({q.b}) ==
        "{\n  float t = 1.0;\n  for (int i = 0; i < n; i += 1) {\n    t *= x;\n  }\n  b = t;\n}\n");
  CHECK(q.slice({q.b}, {q.t}) == "{\n  b = t;\n}\n");
  CHECK(q.slice({q.t}) == "{\n  float t = 1.0;\n  for (int i = 0; i < n; i += 1) {\n    t *= x;\n  }\n}\n");
}

TEST_CASE("branches, jumps and returns go along") {
  Sample q;
  const auto isPositive = [&](VarId var) { return binary(Greater, q.ref(var), literal(0.0f)); };
  q.finish(block(
      declare(q.s, literal(0.0f)),
      ifStmt(isPositive(q.x), block(q.set(q.a, literal(0.0f)), q.set(q.b, literal(0.0f)), returnStmt())),
      q.count(
          block(q.add(q.s, q.ref(q.x)), ifStmt(isPositive(q.s), block(breakStmt())), q.set(q.a, q.ref(q.x)))),
      q.set(q.b, q.ref(q.s))));
  CHECK(
      q.slice({q.a}) ==
      "{\n  float s = 0.0;\n  if (x > 0.0) {\n    a = 0.0;\n    return;\n  }\n"
      "  for (int i = 0; i < n; i += 1) {\n    s += x;\n    if (s > 0.0) {\n      break;\n    }\n    a = x;\n"
      "  }\n}\n");
  // a return before the last write matters, statements after it do not
  CHECK(q.slice({q.s}).find("return") != std::string::npos);
  CHECK(q.slice({q.s}).find("b = s") == std::string::npos);
}

TEST_CASE("a variable that is read before it is final is computed") {
  Sample q;
  q.finish(block(declare(q.s, literal(0.0f)), declare(q.t, literal(0.0f)),
                 q.count(block(q.add(q.s, q.ref(q.x)), q.add(q.t, q.ref(q.s)))), q.set(q.a, q.ref(q.t)),
                 q.set(q.b, q.ref(q.s))));
  CHECK(q.slice({q.a}, {q.s}).find("s += x") != std::string::npos);
  CHECK(q.slice({q.b}, {q.s}) == "{\n  b = s;\n}\n");
}

TEST_CASE("a call is kept for any of the variables that it writes") {
  Sample q;
  Function both;
  both.name = "both";
  const VarId p = addVariable(both, "p", floatType, VarRole::InOut);
  const VarId r = addVariable(both, "r", floatType, VarRole::InOut);
  both.parameterCount = 2;
  Block body = block(assign(varRef(both, p), literal(1.0f)), assign(varRef(both, r), literal(2.0f)));
  const VarId s = q.s, t = q.t;
  Block calls = block(declare(s), declare(t), callStmt(1, exprs(q.ref(s), q.ref(t))), q.set(q.a, q.ref(s)),
                      q.set(q.b, q.ref(t)));
  q.finish(std::move(calls));
  addFunction(q.module, std::move(both), std::move(body));
  CHECK(q.slice({q.a}) == "{\n  float s;\n  float t;\n  both(s, t);\n  a = s;\n}\n");
  // t may be loaded only if the call that writes it is not needed
  CHECK(q.slice({q.a}, {t}).find("both(s, t)") != std::string::npos);
  CHECK(q.slice({q.b}, {t}) == "{\n  b = t;\n}\n");
}

}  // namespace
}  // namespace skc::split
