// SPDX-License-Identifier: MIT
//
// Promise: glslang accepts what we emit as GLSL 3.30 and as ESSL 3.00: every overload of every intrinsic,
// every kind of statement and expression, and whole programs as assembled by the runtime.
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "assemble/assemble.hpp"
#include "assemble/reduce/reduce_program.hpp"
#include "glsl/tool_folder.hpp"
#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "program/descriptors.hpp"
#include "program/sample_module.hpp"

namespace skc::emit {
namespace {

using namespace ir;
using enum BinaryOp;

constexpr Scalar arithmeticScalars[] = {Scalar::Bool,   Scalar::Int,  Scalar::Uint, Scalar::Float,
                                        Scalar::Double, Scalar::Long, Scalar::Ulong};

/// Writes the module's kernels and reduces as whole programs, with accurate intrinsics and the device's, and with both barriers,
/// to a folder, and returns glslang's messages.
std::string glslangOn(const Module& module, std::string_view folderName) {
  const ToolFolder folder(folderName);
  const Program program(module);
  for (sk::assemble::Profile profile : sk::assemble::profiles()) {
    if (profile.webgl) continue;  // tests/web shows its programs to Chromium
    for (const Unit& unit : program.units()) {
      for (const bool accurate : {true, false}) {
        profile.accurate = accurate;
        profile.barrier = accurate && !profile.es ? sk::Barrier::Precise : sk::Barrier::Xor;
        // glslang has `precise` of GLSL 4.00, but not of the extension
        if (profile.barrier == sk::Barrier::Precise && profile.stage == sk::assemble::Stage::Fragment)
          profile.version = "#version 400 core";
        sk::assemble::Variant variant;
        variant.access.resize(unit.kernel.parameters.size(), {.addressing = sk::assemble::Addressing::Plane});
        const std::string text = unit.reduction != nullptr
                                     ? sk::assemble::reduceProgram(profile, *unit.reduction, {})
                                     : sk::assemble::kernelProgram(profile, unit.kernel, variant);
        const bool isDrawn = profile.stage == sk::assemble::Stage::Fragment;
        folder.write(fmt::format("{}-{}{}.{}", unit.kernel.entry, profile.name, accurate ? "" : "-fast",
                                 isDrawn ? "frag" : "comp"),
                     text);
      }
    }
  }
  return folder.glslang();
}

TEST_CASE("the sample file") { CHECK(glslangOn(sampleModule(), "sample") == ""); }

TEST_CASE("every overload of every intrinsic") {
  Module module = testModule();
  KernelBuilder k(module, "all");
  VarId values[std::size(arithmeticScalars)][5];
  for (Scalar scalar : arithmeticScalars) {
    for (int width = 1; width <= 4; ++width) {
      values[static_cast<int>(scalar)][width] =
          k.uniform(spelling(scalar) + std::to_string(width), Type::of(scalar, width));
    }
  }
  VarId matrices[5] = {};
  for (int size = 2; size <= 4; ++size)
    matrices[size] = k.uniform(fmt::format("m{}", size), Type::matrix(size));
  k.output("r", floatType);
  Block body;
  for (const IntrinsicRow& entry : intrinsicRows()) {
    if (entry.id == Intrinsic::AnyLane) continue;  // native code only
    for (const IntrinsicOverload& overload : overloads(entry.id)) {
      std::vector<ExprPtr> args;
      for (Type type : overload.arguments) {
        const VarId var =
            type.isMatrix() ? matrices[type.width] : values[static_cast<int>(type.scalar)][type.width];
        args.push_back(k.ref(var));
      }
      const VarId local = k.local(fmt::format("v{}", body.size()), overload.result);
      body.push_back(declare(local, intrinsic(entry.id, std::move(args))));
    }
  }
  CHECK(body.size() > 400);
  k.finish(std::move(body));
  REQUIRE(validate(module, Stage::Specialized) == "");
  CHECK(glslangOn(module, "intrinsics") == "");
}

TEST_CASE("every operator on every type that has it") {
  Module module = testModule();
  KernelBuilder k(module, "operators");
  std::vector<std::pair<VarId, Type>> values;
  for (Scalar scalar : arithmeticScalars) {
    for (int width = 1; width <= 4; ++width) {
      const Type type = Type::of(scalar, width);
      values.emplace_back(k.uniform(spelling(scalar) + std::to_string(width), type), type);
    }
  }
  k.output("r", floatType);
  Block body;
  const auto add = [&](ExprPtr value) {
    const Type type = value->type;
    body.push_back(declare(k.local(fmt::format("v{}", body.size()), type), std::move(value)));
  };
  for (const auto& [a, type] : values) {
    const auto self = [&, var = a] { return k.ref(var); };
    std::vector<BinaryOp> ops = {Equal, NotEqual};
    if (type.isBool()) ops.insert(ops.end(), {LogicalAnd, LogicalOr});
    if (!type.isBool()) ops.insert(ops.end(), {Add, Sub, Mul, Div, Less, LessEqual, Greater, GreaterEqual});
    if (type.isInteger() || type.isLong()) ops.insert(ops.end(), {Rem, BitAnd, BitOr, BitXor});
    if (type.isInteger()) ops.insert(ops.end(), {ShiftLeft, ShiftRight});
    for (BinaryOp op : ops) add(binary(op, self(), self()));
    if (!type.isBool()) add(unary(UnaryOp::Negate, self()));
    if (type.isInteger() || type.isLong()) add(unary(UnaryOp::BitNot, self()));
    if (type.isBool()) add(unary(UnaryOp::LogicalNot, self()));
    if (type.isInteger() || type.isLong()) add(binary(ShiftLeft, self(), literal(1U)));
    if (!type.isBool()) add(binary(Mul, literalOf(type.component(), 2), self()));
    add(select(k.ref(values[type.width - 1U].first), self(), self()));
    add(select(literal(true), self(), self()));
    for (Scalar to : arithmeticScalars) {
      if (to != type.scalar) add(convert(to, self()));
    }
  }
  k.finish(std::move(body));
  REQUIRE(validate(module, Stage::Specialized) == "");
  CHECK(glslangOn(module, "operators") == "");
}

TEST_CASE("every operator on matrices, and every conversion to a narrow type") {
  Module module = testModule();
  KernelBuilder k(module, "narrow");
  std::vector<VarId> matrices, vectors;
  for (int size = 2; size <= 4; ++size) {
    matrices.push_back(k.uniform(fmt::format("m{}", size), Type::matrix(size)));
    vectors.push_back(k.uniform(fmt::format("v{}", size), Type::of(Scalar::Float, size)));
  }
  const VarId x = k.uniform("x", floatType);
  k.output("r", floatType);
  Block body;
  const auto add = [&](ExprPtr value) {
    const Type type = value->type;
    body.push_back(declare(k.local(fmt::format("t{}", body.size()), type), std::move(value)));
  };
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    const auto m = [&] { return k.ref(matrices[i]); };
    for (BinaryOp op : {Add, Sub, Mul, Equal, NotEqual}) add(binary(op, m(), m()));
    for (BinaryOp op : {Mul, Div}) add(binary(op, m(), k.ref(x)));
    add(binary(Mul, k.ref(x), unary(UnaryOp::Negate, m())));
    add(binary(Mul, m(), k.ref(vectors[i])));
    add(index(module, index(module, m(), literal(1)), literal(0)));
  }
  for (Scalar scalar : {Scalar::Half, Scalar::Char, Scalar::Uchar, Scalar::Short, Scalar::Ushort,
                        Scalar::Unorm8, Scalar::Snorm8, Scalar::Unorm16, Scalar::Snorm16}) {
    add(convert(Scalar::Float, convert(scalar, k.ref(x))));
    for (VarId v : vectors) add(convert(Scalar::Int, convert(scalar, k.ref(v))));
  }
  k.finish(std::move(body));
  REQUIRE(validate(module, Stage::Specialized) == "");
  CHECK(glslangOn(module, "narrow") == "");
}

/// void swapBoth(inout float a, inout float b[3]): passes a local array on, and swaps.
FunctionId addSwap(Module& module, Type array) {
  Function f;
  f.name = "swap";
  addVariable(f, "sample", floatType, VarRole::InOut);
  addVariable(f, "b", array, VarRole::InOut);
  const VarId t = addVariable(f, "t", floatType);
  Block body = block(declare(t, varRef(f, 0)), assign(varRef(f, 0), index(module, varRef(f, 1), literal(1))),
                     assign(index(module, varRef(f, 1), literal(1)), varRef(f, t)));
  return addFunction(module, std::move(f), std::move(body));
}

/// float[3] weights(): a function that returns an array.
FunctionId addWeights(Module& module, Type array) {
  Function f;
  f.name = "weights";
  f.result = array;
  return addFunction(module, std::move(f), block(returnStmt(constantRef(module, 1))));
}

TEST_CASE("every kind of statement, arrays, structs, constants") {
  Module module = testModule();
  const float infinity = std::numeric_limits<float>::infinity();
  const Type array = arrayOf(module, floatType, 3);
  const Type float3 = Type::of(Scalar::Float, 3);
  module.structs.push_back({"Inner", {}, {{"input", float3}, {"flag", Type::of(Scalar::Bool)}}, {}});
  module.structs.push_back(
      {"Outer", {}, {{"inner", Type::structType(0)}, {"id", Type::of(Scalar::Uint)}}, {}});
  const Type outer = Type::structType(1);
  module.constants.push_back({"none", floatType, literal(-infinity), {}});
  module.constants.push_back(
      {"table", array, construct(array, exprs(literal(1.0F), constantRef(module, 0), literal(3.0F))), {}});
  module.constants.push_back({"least", intType, literal(std::numeric_limits<std::int32_t>::min()), {}});
  const FunctionId swap = addSwap(module, array);
  const FunctionId weights = addWeights(module, array);

  KernelBuilder k(module, "statements");
  const auto makeOuter = [&](ExprPtr id) {
    ExprPtr inner = construct(Type::structType(0), exprs(literalOf(float3, 1), literal(true)));
    return construct(outer, exprs(std::move(inner), std::move(id)));
  };
  const VarId s = k.uniform("s", outer);
  const VarId g = k.gather("g", outer, 2, Boundary::Border, makeOuter(literal(7U)));
  const VarId r = k.output("r", outer);
  const VarId q = k.output("output", float3);
  const VarId w = k.local("w", array);
  const VarId o = k.local("o", outer);
  const VarId v = k.local("v", float3);
  const VarId i = k.local("i", intType);
  const VarId t = k.local("t", floatType);
  const auto id = [&](ExprPtr base) { return member(module, std::move(base), 1); };
  ExprPtr at = swizzle(indexOf({StreamRef::Space::Domain, 0}), "xy");
  std::vector<Case> cases;
  cases.push_back({{1, 2}, false, block(assign(swizzle(k.ref(v), "xz"), swizzle(k.ref(v), "yy"))), {}});
  cases.push_back({{3},
                   false,
                   block(scope(block(assign(index(module, k.ref(v), k.ref(i)), literal(1.0F)), breakStmt()))),
                   {}});
  cases.push_back({{}, true, {}, {}});
  Block unusual = block(declare(i, literal(0)), declare(t, literal(0.0F)));
  Block step = block(ifStmt(binary(Less, k.ref(t), literal(2.0F)), block(assign(k.ref(i), Add, literal(1)))),
                     assign(k.ref(t), Add, literal(1.0F)));
  Block rounds = block(
      ifStmt(binary(Equal, k.ref(i), constantRef(module, 2)), block(continueStmt())),
      callStmt(swap, exprs(k.ref(t), k.ref(w))),
      doWhileLoop(block(assign(k.ref(t), Sub, literal(1.0F))), binary(Greater, k.ref(t), literal(0.0F))),
      assign(k.ref(v), Mul, index(module, k.ref(w), k.ref(i))), switchStmt(id(k.ref(s)), std::move(cases)));
  k.finish(block(
      declare(w), callStmt(weights, {}, k.ref(w)), declare(v, literalOf(float3, 2)),
      declare(o, gatherRead(outer, {StreamRef::Space::KernelParameter, g}, std::move(at))),
      forLoop(std::move(unusual), binary(Less, k.ref(i), literal(3)), std::move(step), std::move(rounds)),
      ifStmt(binary(Equal, k.ref(o), k.ref(s)), block(assign(k.ref(q), k.ref(v)), returnStmt())),
      assign(id(k.ref(o)), BitXor, literal(0xffffffffU)), assign(k.ref(q), swizzle(k.ref(v), "zyx")),
      assign(k.ref(r),
             select(binary(Greater, id(k.ref(o)), literal(3U)), k.ref(o), makeOuter(literal(1U))))));
  REQUIRE(validate(module, Stage::Specialized) == "");
  CHECK(glslangOn(module, "statements") == "");
}

}  // namespace
}  // namespace skc::emit
