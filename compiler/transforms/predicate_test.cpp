// SPDX-License-Identifier: MIT
//
// Promises: after predicate all control flow is uniform, and each lane computes what its element does alone.
#include "transforms/predicate.hpp"

#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/uniformity.hpp"
#include "ir/build.hpp"
#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "transforms/testing/interpret_lanes.hpp"
#include "transforms/testing/random_kernel.hpp"

namespace skc {
namespace {

using namespace ir;
struct Outcome {
  Numbers r;
  std::vector<Numbers> pushed;  ///< one list per lane
  bool operator==(const Outcome&) const = default;
};

/// Runs a kernel of u, x, r and an append output, with its mask if any, for elements from `first` on.
Outcome run(const Module& module, std::int32_t u, const std::vector<std::int32_t>& x, std::size_t first,
            std::size_t count, bool inFull, const analysis::Uniformity* shapes) {
  std::vector<Numbers> arguments(4, Numbers(count, 0));
  arguments[0] = Numbers(count, u);
  for (std::size_t i = 0; i < count; ++i) arguments[1][i] = x[first + i];
  const Kernel& kernel = module.kernels.front();
  if (entryMask(module, kernel)) arguments.emplace_back(count, 1);
  LanesResult result =
      interpretLanes(module, kernel.entry, std::move(arguments),
                     {.count = count, .inFull = inFull, .firstIndex = first, .shapes = shapes});
  return {std::move(result.parameters[2]), std::move(result.pushed)};
}

Outcome oneByOne(const Module& module, std::int32_t u, const std::vector<std::int32_t>& x, bool inFull) {
  Outcome all;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Outcome one = run(module, u, x, i, 1, inFull, nullptr);
    all.r.push_back(one.r.front());
    all.pushed.push_back(one.pushed.front());
  }
  return all;
}

void checkLanes(const Module& module) {
  INFO(print(module));
  REQUIRE(validate(module, Stage::Specialized) == "");
  Module lanes = clone(module);
  predicate(lanes);
  INFO(print(lanes));
  REQUIRE(validatePredicated(lanes) == "");
  const analysis::Uniformity shapes(lanes, lanes.kernels.front());
  const std::vector<std::int32_t> x = {0, 1, -1, 2, 7, 3, 5, -4};
  for (const std::int32_t u : {0, 1, 3}) {
    const Outcome expected = oneByOne(module, u, x, false);
    CHECK(oneByOne(lanes, u, x, true) == expected);
    CHECK(run(lanes, u, x, 0, x.size(), true, &shapes) == expected);
  }
}

/// A kernel with a uniform u, an input x and an output r, initially 0; and its body after predicate.
struct Sample {
  Module module = testModule();
  KernelBuilder k{module, "f"};
  VarId u = k.uniform("u", intType), x = k.input("x", intType), r = k.output("r", intType);

  ExprPtr isSmall() const { return binary(BinaryOp::Less, k.ref(x), literal(3)); }
  std::string predicated(Block body) {
    const KernelId id = k.finish(std::move(body));
    predicate(module);
    CHECK(validatePredicated(module) == "");
    const std::string text = print(module, module.functions[module.kernels[id].entry]);
    return text.substr(text.find('{'));
  }
};

TEST_CASE("a short branch is blended, and asks no lane") {
  Sample s;
  CHECK(s.predicated(block(assign(s.k.ref(s.r), literal(0)),
                           ifStmt(s.isSmall(), block(assign(s.k.ref(s.r), BinaryOp::Add, s.k.ref(s.x))),
                                  block(assign(s.k.ref(s.r), literal(7)))))) == R"({
  r = 0;
  bool mask#3 = x < 3;
  r = mask#3 ? r + x : r;
  bool mask#4 = !mask#3;
  r = mask#4 ? 7 : r;
}
)");
  CHECK_FALSE(entryMask(s.module, s.module.kernels.front()));
}

TEST_CASE("uniform control flow stays as it is") {
  Sample s;
  CHECK(s.predicated(block(assign(s.k.ref(s.r), literal(0)),
                           ifStmt(binary(BinaryOp::Less, s.k.ref(s.u), literal(3)), block(returnStmt())),
                           assign(s.k.ref(s.r), s.k.ref(s.x)))) == R"({
  r = 0;
  if (u < 3) {
    return;
  }
  r = x;
}
)");
}

TEST_CASE("a loop runs until all lanes have left it, and its counter stays uniform") {
  Sample s;
  const VarId i = s.k.local("i", intType);
  CHECK(s.predicated(
            block(assign(s.k.ref(s.r), literal(0)),
                  forLoop(block(declare(i, literal(0))), binary(BinaryOp::Less, s.k.ref(i), s.k.ref(s.u)),
                          block(assign(s.k.ref(i), BinaryOp::Add, literal(1))),
                          block(ifStmt(binary(BinaryOp::Less, s.k.ref(s.x), s.k.ref(i)), block(breakStmt())),
                                assign(s.k.ref(s.r), BinaryOp::Add, s.k.ref(i)))))) == R"({
  r = 0;
  for (int i = 0, bool live = active; i < u && AnyLane(live); i += 1) {
    bool mask = live && x < i;
    live = live && !mask;
    r = live ? r + i : r;
  }
}
)");
  CHECK(entryMask(s.module, s.module.kernels.front()) == 3U);
}

TEST_CASE("a counter that is read after its loop has a uniform copy inside") {
  Sample s;
  const VarId n = s.k.local("n", intType);
  CHECK(s.predicated(
            block(declare(n, literal(2)),
                  whileLoop(binary(BinaryOp::LogicalAnd, binary(BinaryOp::Less, s.k.ref(n), s.k.ref(s.u)),
                                   binary(BinaryOp::Less, s.k.ref(n), s.k.ref(s.x))),
                            block(assign(s.k.ref(n), BinaryOp::Add, literal(3)))),
                  assign(s.k.ref(s.r), s.k.ref(n)))) == R"({
  int n = 2;
  int count = 2;
  for (bool live = active && count < x; count < u && AnyLane(live); live = live && count < x) {
    count += 3;
    n = live ? n + 3 : n;
  }
  r = n;
}
)");
}

TEST_CASE("a counter that lanes change in different iterations has no copy") {
  Sample s;
  const VarId n = s.k.local("n", intType);
  CHECK(s.predicated(block(declare(n, literal(0)),
                           whileLoop(binary(BinaryOp::Less, s.k.ref(n), s.k.ref(s.x)),
                                     block(ifStmt(s.isSmall(), block(continueStmt())),
                                           assign(s.k.ref(n), BinaryOp::Add, literal(1)))),
                           assign(s.k.ref(s.r), s.k.ref(n))))
            .find("count") == std::string::npos);
}

TEST_CASE("a lane that goes on with the next round keeps what the others change in this one") {
  Sample s;
  const VarId i = s.k.local("i", intType);
  CHECK(s.predicated(
            block(assign(s.k.ref(s.r), literal(0)),
                  forLoop(block(declare(i, literal(0))), binary(BinaryOp::Less, s.k.ref(i), s.k.ref(s.u)),
                          block(assign(s.k.ref(i), BinaryOp::Add, literal(1))),
                          block(ifStmt(s.isSmall(), block(continueStmt())),
                                assign(s.k.ref(s.r), BinaryOp::Add, s.k.ref(i)))))) == R"({
  r = 0;
  for (int i = 0; i < u; i += 1) {
    bool round = true;
    bool mask = round && x < 3;
    round = round && !mask;
    r = round ? r + i : r;
  }
}
)");
}

TEST_CASE("the lanes of a switch become more from case to case, and fewer at a break") {
  Sample s;
  std::vector<Case> cases;
  cases.push_back({{1, 2}, false, block(assign(s.k.ref(s.r), literal(5))), {}});
  cases.push_back({{}, true, block(assign(s.k.ref(s.r), BinaryOp::Add, literal(1)), breakStmt()), {}});
  cases.push_back({{3}, false, block(assign(s.k.ref(s.r), literal(9))), {}});
  CHECK(s.predicated(block(assign(s.k.ref(s.r), literal(0)), switchStmt(s.k.ref(s.x), std::move(cases)))) ==
        R"({
  r = 0;
  int chosen = x;
  bool running = chosen == 1 || chosen == 2;
  r = running ? 5 : r;
  running = running || !(chosen == 1 || chosen == 2 || chosen == 3);
  r = running ? r + 1 : r;
  running = false;
  running = chosen == 3;
  r = running ? 9 : r;
}
)");
}

TEST_CASE("pushes have a mask, and lanes beyond the domain push nothing") {
  Sample s;
  const VarId out = s.k.variableOutput("out", intType);
  const StreamRef stream{StreamRef::Space::KernelParameter, out};
  CHECK(s.predicated(block(assign(s.k.ref(s.r), literal(0)), push(stream, s.k.ref(s.x)),
                           ifStmt(s.isSmall(), block(push(stream, literal(1)))))) == R"({
  r = 0;
  where (active) push($3, x);
  bool mask = active && x < 3;
  if (AnyLane(mask)) {
    where (mask) push($3, 1);
  }
}
)");
  CHECK(entryMask(s.module, s.module.kernels.front()) == 4U);
}

/// int next(int& n) { if (n < 0) return 1; n = n + 1; return 2; }
FunctionId addNext(Module& module) {
  Function next{.name = "next", .result = intType, .variables = {}, .body = {}, .loc = {}};
  const VarId n = addVariable(next, "n", intType, VarRole::InOut);
  Block body =
      block(ifStmt(binary(BinaryOp::Less, varRef(next, n), literal(0)), block(returnStmt(literal(1)))),
            assign(varRef(next, n), BinaryOp::Add, literal(1)), returnStmt(literal(2)));
  return addFunction(module, std::move(next), std::move(body));
}

TEST_CASE("what a call changes is blended by the caller") {
  Sample s;
  const FunctionId next = addNext(s.module);
  const VarId a = s.k.local("a", intType);
  CHECK(s.predicated(block(declare(a, s.k.ref(s.x)), assign(s.k.ref(s.r), literal(0)),
                           ifStmt(s.isSmall(), block(callStmt(next, exprs(s.k.ref(a)), s.k.ref(s.r)))))) ==
        R"({
  int a = x;
  r = 0;
  bool mask = x < 3;
  int copy#5 = a;
  int copy#6;
  copy#6 = next(copy#5);
  a = mask ? copy#5 : a;
  r = mask ? copy#6 : r;
}
)");
  const std::string text = print(s.module, s.module.functions[next]);
  CHECK(text.substr(text.find('{')) == R"({
  bool active = true;
  int result;
  bool mask = active && n < 0;
  result = mask ? 1 : result;
  active = active && !mask;
  n = active ? n + 1 : n;
  return active ? 2 : result;
}
)");
}

/// bool isPower(int n) { while (n != 1) n = n - 3; return true; }
FunctionId addEndless(Module& module) {
  Function endless{
      .name = "endless", .result = Type::of(Scalar::Bool), .variables = {}, .body = {}, .loc = {}};
  const VarId n = addVariable(endless, "n", intType, VarRole::In);
  Block body = block(whileLoop(binary(BinaryOp::NotEqual, varRef(endless, n), literal(1)),
                               block(assign(varRef(endless, n), BinaryOp::Sub, literal(3)))),
                     returnStmt(literal(true)));
  return addFunction(module, std::move(endless), std::move(body));
}

TEST_CASE("both operands of a vector's logical operator are computed") {
  Sample s;
  const FunctionId endless = addEndless(s.module);
  const Type pair = Type::of(Scalar::Bool, 2);
  const VarId are = s.k.local("are", pair);
  ExprPtr either = binary(BinaryOp::LogicalOr, construct(pair, exprs(s.isSmall(), literal(true))),
                          construct(pair, exprs(call(s.module, endless, exprs(s.k.ref(s.x))))));
  CHECK(s.predicated(block(assign(s.k.ref(s.r), literal(0)), declare(are, std::move(either)))) == R"({
  r = 0;
  bool2 are = bool2{x < 3, true} || bool2{endless(x, active)};
}
)");
}

TEST_CASE("a call that may not end stays behind its condition") {
  Sample s;
  const FunctionId endless = addEndless(s.module);
  const VarId is = s.k.local("is", Type::of(Scalar::Bool));
  ExprPtr guarded = binary(BinaryOp::LogicalAnd, s.isSmall(), call(s.module, endless, exprs(s.k.ref(s.x))));
  CHECK(s.predicated(block(assign(s.k.ref(s.r), literal(0)), declare(is, std::move(guarded)))) == R"({
  r = 0;
  bool decided = x < 3;
  bool mask = active && decided;
  if (AnyLane(mask)) {
    decided = mask ? endless(x, mask) : decided;
  }
  bool is = decided;
}
)");
}

TEST_CASE("each lane computes what its element computes alone") {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    INFO("seed " << seed);
    checkLanes(randomKernel(seed));
  }
}

}  // namespace
}  // namespace skc
