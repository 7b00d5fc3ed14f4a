// SPDX-License-Identifier: MIT
//
// Promises: every uniform value is found, also in components of vectors and after lanes have left a loop; no
// varying value is taken for uniform.
#include "analysis/uniformity.hpp"

#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"

namespace skc::analysis {
namespace {

using namespace ir;

constexpr Type int2Type = Type::of(Scalar::Int, 2);
constexpr StreamRef domain{StreamRef::Space::Domain, 0};

/// The shape of each leaf as "u", "c" or "v".
std::string letters(std::span<const Shape> shapes) {
  std::string text;
  for (const Shape shape : shapes) text += "ucv"[static_cast<int>(shape)];
  return text;
}

/// A kernel with a uniform u, an input x and an output r.
struct Sample {
  Module module = testModule();
  KernelBuilder k{module, "f"};
  VarId u = k.uniform("u", intType), x = k.input("x", intType), r = k.output("r", intType);

  Uniformity finish(Block body) {
    const KernelId id = k.finish(std::move(body));
    return {module, module.kernels[id]};
  }
  FunctionId entry() const { return module.kernels.front().entry; }
  const Block& body() const { return module.functions[entry()].body; }
  ExprPtr isVarying() const { return binary(BinaryOp::Less, k.ref(x), literal(3)); }
  ExprPtr isUniform() const { return binary(BinaryOp::Less, k.ref(u), literal(3)); }
};

TEST_CASE("x of the index is consecutive, and other components are uniform") {
  Sample s;
  const VarId p = s.k.local("p", int2Type), q = s.k.local("q", int2Type),
              f = s.k.local("f", Type::of(Scalar::Float, 2));
  const VarId w = s.k.local("w", Type::of(Scalar::Uint)), last = s.k.local("last", intType);
  const Uniformity found =
      s.finish(block(declare(p, binary(BinaryOp::Add, swizzle(indexOf(domain), "xy"),
                                       construct(int2Type, exprs(s.k.ref(s.u), literal(2))))),
                     declare(q, binary(BinaryOp::Mul, s.k.ref(p), literal(2))),
                     declare(f, convert(Scalar::Float, s.k.ref(p))),
                     declare(w, convert(Scalar::Uint, swizzle(s.k.ref(p), "x"))),
                     declare(last, binary(BinaryOp::Sub, s.k.ref(s.u), swizzle(s.k.ref(p), "x")))));
  CHECK(letters(found.of(s.entry(), p)) == "cu");
  CHECK(letters(found.of(s.entry(), q)) == "vu");
  CHECK(letters(found.of(s.entry(), f)) == "vu");
  CHECK(letters(found.of(s.entry(), w)) == "c");
  CHECK(letters(found.of(s.entry(), last)) == "v");
  CHECK(found.of(s.entry(), *varRef(s.module.functions[s.entry()], p)) == Shape::Varying);
}

TEST_CASE("a variable that is uniform here and consecutive there varies") {
  Sample s;
  const VarId a = s.k.local("a", intType);
  const Uniformity found = s.finish(
      block(declare(a), ifStmt(s.isUniform(), block(assign(s.k.ref(a), swizzle(indexOf(domain), "x"))),
                               block(assign(s.k.ref(a), literal(0))))));
  CHECK(letters(found.of(s.entry(), a)) == "v");
  CHECK_FALSE(found.diverges(s.entry(), s.body()[1]));
}

TEST_CASE("an assignment under a varying condition varies, and is blended unless the variable lives there") {
  Sample s;
  const VarId outer = s.k.local("outer", intType), inner = s.k.local("inner", intType);
  const Uniformity found =
      s.finish(block(declare(outer, literal(0)),
                     ifStmt(s.isVarying(), block(declare(inner, literal(1)),
                                                 assign(s.k.ref(inner), BinaryOp::Add, literal(1)),
                                                 assign(s.k.ref(outer), literal(1))))));
  const Stmt& branch = s.body()[1];
  const Block& then = std::get<If>(branch.node).then;
  CHECK(found.diverges(s.entry(), branch));
  CHECK(letters(found.of(s.entry(), outer)) == "v");
  CHECK(letters(found.of(s.entry(), inner)) == "u");
  CHECK(found.blends(s.entry(), then[2], outer));
  CHECK_FALSE(found.blends(s.entry(), then[1], inner));
}

/// for (int i = 0; i < u; ++i) { if (x < 3) break; }
Stmt leftLoop(Sample& s, VarId i, Stmt jump) {
  return forLoop(block(declare(i, literal(0))), binary(BinaryOp::Less, s.k.ref(i), s.k.ref(s.u)),
                 block(assign(s.k.ref(i), BinaryOp::Add, literal(1))),
                 block(ifStmt(s.isVarying(), block(std::move(jump)))));
}

TEST_CASE("a loop's counter is uniform though lanes leave it one by one") {
  Sample s;
  const VarId i = s.k.local("i", intType);
  const Uniformity found = s.finish(block(leftLoop(s, i, breakStmt()), assign(s.k.ref(s.r), literal(0))));
  CHECK(letters(found.of(s.entry(), i)) == "u");
  CHECK(letters(found.of(s.entry(), s.r)) == "u");
  CHECK(found.diverges(s.entry(), s.body()[0]));
  CHECK_FALSE(found.skips(s.entry(), s.body()[0]));
}

TEST_CASE("one that is read behind the loop is not") {
  Sample s;
  const VarId i = s.k.local("i", intType);
  Loop loop = std::move(std::get<Loop>(leftLoop(s, i, breakStmt()).node));
  Block body = std::move(loop.init);
  loop.init.clear();
  body.push_back({{}, std::move(loop)});
  body.push_back(assign(s.k.ref(s.r), s.k.ref(i)));
  const Uniformity found = s.finish(std::move(body));
  CHECK(letters(found.of(s.entry(), i)) == "v");
}

TEST_CASE("a continue ends an iteration, and a return the loops around it") {
  Sample s;
  const VarId i = s.k.local("i", intType), j = s.k.local("j", intType);
  const Uniformity found = s.finish(
      block(leftLoop(s, i, continueStmt()), leftLoop(s, j, returnStmt()), assign(s.k.ref(s.r), literal(0))));
  CHECK(found.skips(s.entry(), s.body()[0]));
  CHECK_FALSE(found.diverges(s.entry(), s.body()[0]));
  CHECK(found.diverges(s.entry(), s.body()[1]));
  CHECK(found.returnsEarly(s.entry()));
  CHECK(letters(found.of(s.entry(), s.r)) == "v");
  CHECK(letters(found.of(s.entry(), j)) == "u");
}

TEST_CASE("an element at a varying index may be any") {
  Sample s;
  const Type arrayType = arrayOf(s.module, intType, 3);
  const VarId a = s.k.local("a", arrayType), b = s.k.local("b", arrayType), read = s.k.local("read", intType);
  const auto zeros = [&] { return construct(arrayType, exprs(literal(0), literal(0), literal(0))); };
  const Uniformity found = s.finish(block(declare(a, zeros()), declare(b, zeros()),
                                          assign(index(s.module, s.k.ref(a), s.k.ref(s.x)), literal(1)),
                                          assign(index(s.module, s.k.ref(b), s.k.ref(s.u)), literal(1)),
                                          declare(read, index(s.module, s.k.ref(b), s.k.ref(s.x)))));
  CHECK(letters(found.of(s.entry(), a)) == "v");
  CHECK(letters(found.of(s.entry(), b)) == "u");
  CHECK(letters(found.of(s.entry(), read)) == "v");
}

TEST_CASE("parameters are what all callers give, and results what comes back") {
  Sample s;
  Function twice{.name = "twice", .result = intType, .variables = {}, .body = {}, .loc = {}};
  const VarId n = addVariable(twice, "n", intType, VarRole::In),
              m = addVariable(twice, "m", intType, VarRole::In);
  Block body = block(returnStmt(binary(BinaryOp::Mul, varRef(twice, n), varRef(twice, n))));
  const FunctionId id = addFunction(s.module, std::move(twice), std::move(body));
  const VarId a = s.k.local("a", intType);
  const Uniformity found = s.finish(block(
      declare(a, call(s.module, id, exprs(s.k.ref(s.u), s.k.ref(s.x)))),
      ifStmt(s.isVarying(), block(assign(s.k.ref(s.r), call(s.module, id, exprs(literal(1), literal(2))))))));
  CHECK(letters(found.of(id, n)) == "u");
  CHECK(letters(found.of(id, m)) == "v");
  CHECK(letters(found.resultOf(id)) == "u");
  CHECK(letters(found.of(s.entry(), a)) == "u");
  CHECK(found.isCalledDivergently(id));
}

TEST_CASE("lanes of a fold stand apart along x") {
  Module module = testModule();
  KernelBuilder k(module, "total");
  k.input("x", intType);
  const VarId sum = k.accumulator("sum", intType), p = k.local("p", int2Type);
  const KernelId id = k.finish(block(declare(p, swizzle(indexOf(domain), "xy"))));
  const Uniformity found(module, module.kernels[id]);
  CHECK(letters(found.of(module.kernels[id].entry, p)) == "vu");
  CHECK(letters(found.of(module.kernels[id].entry, sum)) == "v");
}

TEST_CASE("along y, the row's index varies and the column's is uniform") {
  Sample s;
  const VarId p = s.k.local("p", int2Type), i = s.k.local("i", intType), kept = s.k.local("kept", intType);
  Block body =
      block(declare(p, swizzle(indexOf(domain), "xy")), declare(i, literal(0)), declare(kept, literal(0)),
            ifStmt(binary(BinaryOp::Less, swizzle(s.k.ref(p), "x"), literal(3)),
                   block(assign(s.k.ref(i), swizzle(s.k.ref(p), "x")))),
            ifStmt(binary(BinaryOp::Less, swizzle(s.k.ref(p), "y"), literal(3)),
                   block(assign(s.k.ref(kept), literal(1)))),
            assign(s.k.ref(s.r), binary(BinaryOp::Add, s.k.ref(i), s.k.ref(kept))));
  const KernelId id = s.k.finish(std::move(body));
  const Uniformity found(s.module, s.module.kernels[id], Axis::Y);
  CHECK(letters(found.of(s.entry(), p)) == "uv");
  CHECK(letters(found.of(s.entry(), s.x)) == "v");
  CHECK(letters(found.of(s.entry(), i)) == "u");
  CHECK(letters(found.of(s.entry(), kept)) == "v");
  CHECK(!found.diverges(s.entry(), s.body()[3]));
  CHECK(found.diverges(s.entry(), s.body()[4]));
}

}  // namespace
}  // namespace skc::analysis
