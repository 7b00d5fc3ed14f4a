// SPDX-License-Identifier: MIT
//
// Promises: each rule of ir.hpp is checked, and a valid module passes.
#include "ir/validate.hpp"

#include <functional>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"

namespace skc::ir {
namespace {

const Type float2 = Type::of(Scalar::Float, 2);

/// The result of validate for a kernel `void k(float a, float x<>, float u[], out float r<>)` with a local
/// float `t`, a local int `i` and this body.
std::string verdict(const std::function<Block(KernelBuilder&)>& body) {
  Module module = testModule();
  KernelBuilder k(module, "k");
  k.uniform("a", floatType);
  k.input("x", floatType);
  k.gather("u", floatType, 1);
  k.output("r", floatType);
  k.local("t", floatType);
  k.local("i", intType);
  Block statements = body(k);
  k.finish(std::move(statements));
  return validate(module, Stage::Lowered);
}

constexpr VarId a = 0, x = 1, u = 2, r = 3, t = 4, i = 5;

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

#define CHECK_VIOLATION(part, ...)                                                          \
  CHECK_THAT(verdict([]([[maybe_unused]] KernelBuilder& k) { return block(__VA_ARGS__); }), \
             Catch::Contains(part))
#define CHECK_VALID(...) \
  CHECK(verdict([]([[maybe_unused]] KernelBuilder& k) { return block(__VA_ARGS__); }).empty())

TEST_CASE("a valid body passes") {
  CHECK_VALID(declare(t, gatherRead(floatType, KernelBuilder::stream(u), literal(3))),
              assign(k.ref(r), binary(BinaryOp::Mul, k.ref(t), binary(BinaryOp::Add, k.ref(a), k.ref(x)))));
}

TEST_CASE("the violation says where it is") {
  const std::string text = verdict([](KernelBuilder& k) {
    Stmt stmt = assign(k.ref(r), literal(1));
    stmt.loc.line = 7;
    return block(std::move(stmt));
  });
  CHECK(contains(text, "function @0 'k'"));
  CHECK(contains(text, "line 7"));
}

TEST_CASE("no conversion is implicit") {
  CHECK_VIOLATION("operands of different types",
                  assign(k.ref(r), binary(BinaryOp::Add, k.ref(x), literal(1))));
  CHECK_VIOLATION("another type is assigned", assign(k.ref(r), literal(1)));
  CHECK_VIOLATION("initialised with another type", declare(t, literal(1)));
  CHECK_VIOLATION("a condition is no bool", ifStmt(literal(1), {}));
  CHECK_VIOLATION("is no bool", assign(k.ref(r), select(literal(1), k.ref(x), k.ref(x))));
  CHECK_VIOLATION("no number", assign(k.ref(r), binary(BinaryOp::Add, literal(true), literal(true))));
}

TEST_CASE("a scalar may stand beside a vector, but not in a comparison") {
  const auto vector = [] { return literalOf(float2, 1); };
  CHECK_VALID(assign(k.ref(r), intrinsic(Intrinsic::Length,
                                         exprs(binary(BinaryOp::Mul, literal(2.0F), literalOf(float2, 1))))));
  Module module = testModule();
  KernelBuilder k(module, "k");
  k.output("r", Type::of(Scalar::Bool, 2));
  k.finish(block(assign(k.ref(0), binary(BinaryOp::Less, vector(), literal(1.0F)))));
  CHECK(contains(validate(module, Stage::Lowered), "operands of different types"));
}

TEST_CASE("places are mutable variables and parts of them") {
  CHECK_VALID(assign(k.ref(a), literal(1.0F)));   // the function's own copy
  CHECK_VIOLATION("constant 'x' is assigned to", assign(k.ref(x), literal(1.0F)));
  CHECK_VIOLATION("no place", assign(literal(1.0F), literal(1.0F)));
  Module module = testModule();
  KernelBuilder k(module, "k");
  k.output("r", float2);
  k.finish(block(assign(swizzle(k.ref(0), "xx"), literalOf(float2, 0))));
  CHECK(contains(validate(module, Stage::Lowered), "assigned twice"));
}

TEST_CASE("variables are declared once and used where they are visible") {
  CHECK_VIOLATION("'t' is not visible", assign(k.ref(r), k.ref(t)));
  CHECK_VIOLATION("'t' is not visible", scope(block(declare(t, literal(1.0F)))), assign(k.ref(r), k.ref(t)));
  CHECK_VIOLATION("declared twice", declare(t), declare(t));
  CHECK_VIOLATION("parameter 'a' is declared", declare(a));
  CHECK_VIOLATION("'i' is not visible", forLoop(block(declare(i, literal(0))), literal(false), {}, {}),
                  assign(k.ref(i), literal(1)));
}

TEST_CASE("gathers are read by index only") {
  CHECK_VIOLATION("gather 'u' is used as a value", assign(k.ref(r), k.ref(u)));
  CHECK_VIOLATION("no gather is read by index",
                  assign(k.ref(r), gatherRead(floatType, KernelBuilder::stream(x), literal(1))));
  CHECK_VIOLATION("not int of its rank",
                  assign(k.ref(r), gatherRead(floatType, KernelBuilder::stream(u), literal(1U))));
  CHECK_VIOLATION("too early", assign(k.ref(r), gatherRead(floatType, {StreamRef::Space::KernelParameter, u},
                                                           literal(1))));
  CHECK_VIOLATION("no gather, element or append output",
                  declare(i, swizzle(indexOf(KernelBuilder::stream(a)), "x")));
  CHECK_VALID(declare(i, swizzle(indexOf({StreamRef::Space::Domain, 0}), "x")));
}

TEST_CASE("break and continue stand in loops, and a return fits its function") {
  CHECK_VIOLATION("in no loop or switch", breakStmt());
  CHECK_VIOLATION("in no loop", continueStmt());
  CHECK_VIOLATION("a return has another type", returnStmt(literal(1.0F)));
  CHECK_VALID(
      whileLoop(literal(true), block(ifStmt(literal(true), block(breakStmt()), block(continueStmt())))));
}

TEST_CASE("a switch is over integers, each case once") {
  const auto cases = [](std::vector<std::int64_t> first, std::vector<std::int64_t> second) {
    std::vector<Case> list;
    list.push_back({std::move(first), false, {}, {}});
    list.push_back({std::move(second), false, {}, {}});
    return list;
  };
  CHECK(contains(verdict([&](KernelBuilder&) { return block(switchStmt(literal(1), cases({1}, {2, 1}))); }),
                 "a case twice"));
  CHECK(contains(verdict([&](KernelBuilder& k) { return block(switchStmt(k.ref(x), cases({1}, {2}))); }),
                 "no int or uint"));
  CHECK(verdict([&](KernelBuilder&) { return block(switchStmt(literal(1), cases({1}, {2}))); }).empty());
}

/// void twice(inout float p, inout float q)
FunctionId addTwice(Module& module) {
  Function function;
  function.name = "twice";
  addVariable(function, "p", floatType, VarRole::InOut);
  addVariable(function, "q", floatType, VarRole::InOut);
  return addFunction(module, std::move(function), {});
}

TEST_CASE("calls fit their functions") {
  Module module = testModule();
  const FunctionId twice = addTwice(module);
  const auto check = [&](std::string_view part, const std::function<Stmt(KernelBuilder&)>& make) {
    KernelBuilder k(module, "k");
    k.output("r", floatType);
    k.output("s", floatType);
    module.kernels.clear();
    module.functions.resize(1);
    Stmt stmt = make(k);
    k.finish(block(std::move(stmt)));
    CHECK_THAT(validate(module, Stage::Lowered), Catch::Contains(std::string(part)));
  };
  check("too many or too few", [&](KernelBuilder& k) { return callStmt(twice, exprs(k.ref(0))); });
  check("lvalues that it writes overlap",
        [&](KernelBuilder& k) { return callStmt(twice, exprs(k.ref(0), k.ref(0))); });
  check("no place", [&](KernelBuilder& k) { return callStmt(twice, exprs(k.ref(0), literal(1.0F))); });
  check("has another type", [&](KernelBuilder& k) { return callStmt(twice, exprs(k.ref(0), literal(1))); });
  check("has an effect", [&](KernelBuilder& k) {
    return assign(k.ref(0), makeExpr(floatType, Call{twice, exprs(k.ref(0), k.ref(1))}));
  });
}

TEST_CASE("functions do not recurse") {
  Module module = testModule();
  Function function;
  function.name = "f";
  addFunction(module, std::move(function), {});
  module.functions[0].body.push_back(callStmt(0, {}));
  CHECK(contains(validate(module, Stage::Lowered), "calls itself"));
}

TEST_CASE("constants name earlier constants only") {
  Module module = testModule();
  module.constants.push_back({"p", floatType, literal(1.0F), {}});
  module.constants.push_back({"q", floatType, constantRef(module, 0), {}});
  CHECK(validate(module, Stage::Lowered).empty());
  std::swap(module.constants[0], module.constants[1]);
  CHECK(contains(validate(module, Stage::Lowered), "before it is declared"));
}

TEST_CASE("arrays have elements") {
  Module module = testModule();
  module.arrays.push_back({floatType, 1});
  CHECK(validate(module, Stage::Lowered).empty());
  module.arrays[0].length = 0;
  CHECK(contains(validate(module, Stage::Lowered), "an array has no elements"));
}

TEST_CASE("constructors are given what they need") {
  Module module = testModule();
  module.structs.push_back({"Hit", {}, {{"t", floatType}, {"id", intType}}, {}});
  const Type hit = Type::structType(0);
  const auto check = [&](ExprPtr value) {
    module.constants.clear();
    const Type type = value->type;
    module.constants.push_back({"c", type, std::move(value), {}});
    return validate(module, Stage::Lowered);
  };
  CHECK(check(construct(hit, exprs(literal(1.0F), literal(2)))).empty());
  CHECK(contains(check(construct(hit, exprs(literal(1.0F)))), "too many or too few values"));
  CHECK(contains(check(construct(hit, exprs(literal(1), literal(2)))), "another type"));
  CHECK(contains(check(construct(float2, exprs(literal(1)))), "another component type"));
  CHECK(contains(check(construct(Type::of(Scalar::Float, 3), exprs(literal(1.0F), literal(1.0F)))),
                 "components"));
  CHECK(check(construct(arrayOf(module, floatType, 2), exprs(literal(1.0F), literal(2.0F)))).empty());
  CHECK(contains(check(construct(arrayOf(module, floatType, 3), exprs(literal(1.0F)))),
                 "too many or too few values"));
}

TEST_CASE("kernels and their entries agree") {
  const auto change = [](const std::function<void(Module&)>& edit) {
    Module module = testModule();
    KernelBuilder k(module, "sum");
    k.input("x", floatType);
    k.accumulator("total", floatType, literal(0.0F));
    k.finish({});
    REQUIRE(validate(module, Stage::Lowered).empty());
    edit(module);
    return validate(module, Stage::Lowered);
  };
  CHECK(contains(change([](Module& m) { m.functions[0].variables[0].role = VarRole::In; }), "another role"));
  CHECK(contains(change([](Module& m) { m.kernels[0].params[0].type = intType; }), "another type or rank"));
  CHECK(contains(change([](Module& m) { m.kernels[0].params[1].identity = literal(0); }), "another type"));
  CHECK(contains(change([](Module& m) { m.kernels[0].reduction.reset(); }), "go together"));
  CHECK(contains(change([](Module& m) { m.kernels[0].entry = 9; }), "not in the table"));
  const FoldPattern ofElement{{{{0, {}, floatType, 1}, BinaryOp::Add, {}}}, true};
  CHECK(contains(change([&](Module& m) { m.kernels[0].reduction->pattern = ofElement; }), "no accumulator"));
}

TEST_CASE("a combining kernel takes its operands from parameters of the same role and type") {
  const auto withOperand = [](std::uint32_t operand) {
    Module module = testModule();
    KernelBuilder k(module, "sum");
    k.accumulator("total", floatType, literal(0.0F));
    k.input("x", floatType);
    k.uniform("scale", floatType);
    k.uniform("n", intType);
    k.spec("weight", floatType);
    k.finish({});
    KernelBuilder combine(module, "sum");
    combine.input("total_part", floatType);
    combine.accumulator("total", floatType);
    combine.uniform("scale", floatType);
    combine.finish({});
    module.kernels[0].reduction->combine = 1;
    module.kernels[0].reduction->operands = {0, 0, operand};
    return validate(module, Stage::Lowered);
  };
  CHECK(withOperand(2) == "");
  for (const std::uint32_t other : {1U, 3U, 4U, 5U}) {
    INFO(other);
    CHECK(
        contains(withOperand(other), "an operand of the combining kernel is not there, or of another kind"));
  }
}

TEST_CASE("after specialize-gathers, streams are parameters and functions have one owner") {
  Module module = testModule();
  KernelBuilder k(module, "k");
  const VarId g = k.gather("u", floatType, 1);
  const VarId out = k.output("r", floatType);
  k.finish(
      block(assign(k.ref(out), gatherRead(floatType, {StreamRef::Space::KernelParameter, g}, literal(1)))));
  CHECK(validate(module, Stage::Specialized).empty());
  Kernel again;
  again.name = "again";
  again.entry = 0;
  for (const KernelParam& param : module.kernels[0].params) {
    KernelParam& made = again.params.emplace_back();
    made.name = param.name;
    made.role = param.role;
    made.type = param.type;
    made.rank = param.rank;
  }
  module.kernels.push_back(std::move(again));
  CHECK(contains(validate(module, Stage::Specialized), "belongs to two kernels"));
}

TEST_CASE("masks and questions to other lanes come with predicate, and so does an entry's mask") {
  Module module = testModule();
  KernelBuilder k(module, "k");
  const VarId value = k.input("x", floatType), out = k.variableOutput("out", floatType);
  k.finish(block(push({StreamRef::Space::KernelParameter, out}, k.ref(value))));
  CHECK(validate(module, Stage::Specialized).empty());
  Function& entry = module.functions[0];
  auto& pushed = std::get<Push>(entry.body[0].node);
  pushed.mask = literal(true);
  CHECK(contains(validate(module, Stage::Specialized), "a mask before predicate"));
  CHECK(validate(module, Stage::Predicated).empty());
  pushed.mask = literal(1);
  CHECK(contains(validate(module, Stage::Predicated), "a condition is no bool"));
  pushed.mask.reset();
  pushed.value =
      select(intrinsic(Intrinsic::AnyLane, exprs(literal(true))), std::move(pushed.value), literal(0.0F));
  CHECK(contains(validate(module, Stage::Specialized), "lanes are asked about"));
  CHECK(validate(module, Stage::Predicated).empty());
  addVariable(entry, "active", Type::of(Scalar::Bool), VarRole::In);
  CHECK(contains(validate(module, Stage::Specialized), "too many or too few parameters"));
  CHECK(validate(module, Stage::Predicated).empty());
  entry.variables.back().type = intType;
  CHECK(contains(validate(module, Stage::Predicated), "is no mask"));
}

}  // namespace
}  // namespace skc::ir
