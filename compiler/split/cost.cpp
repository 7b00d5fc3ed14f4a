// SPDX-License-Identifier: MIT
#include "split/cost.hpp"

#include <algorithm>
#include <iterator>

#include "ir/call_graph.hpp"
#include "ir/counted_loop.hpp"
#include "ir/op_weight.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"

namespace skc::split {
namespace {

using namespace ir;

/// Assumed trip count of a data-dependent loop.
constexpr double unknownTripCount = 16;
constexpr double intrinsicCost = 4;
constexpr double doubleCost = 6;   // per operation: 2 in native GLSL doubles, 9 to 15 in pairs of floats
constexpr double longCost = 4;   // per operation, of two words
constexpr double addressCost = 4;

void collectPlanes(const Module& module, Type type, std::vector<Type>& planes) {
  if (type.kind == Type::Kind::Struct) {
    for (const StructField& field : module.structs[type.index].fields) {
      collectPlanes(module, field.type, planes);
    }
  } else if (type.isMatrix()) {
    planes.insert(planes.end(), type.width, type.indexed());
  } else if (type.is64Bit()) {
    const std::vector<Type> own = widePlanes(type);
    planes.insert(planes.end(), own.begin(), own.end());
  } else {
    planes.push_back(type);
  }
}

/// The cost of a node itself, without its operands.
double nodeCost(const Module& module, const Expr& expr,
                const std::unordered_map<FunctionId, double>& functions) {
  const double width = expr.type.width * (expr.type.isDouble() ? doubleCost
                                          : expr.type.isLong() ? longCost
                                                               : 1);
  return match(
      expr.node, [](const Literal&) { return 0.0; }, [](const VarRef&) { return 0.0; },
      [](const ConstantRef&) { return 0.0; }, [&](const Unary&) { return width; },
      [&](const Binary&) { return width; }, [&](const Select&) { return width; },
      [&](const Convert&) { return width; }, [](const Construct&) { return 0.0; },
      [](const Swizzle&) { return 0.0; }, [](const Member&) { return 0.0; },
      [](const Index&) { return addressCost; }, [&](const Call& n) { return functions.at(n.callee); },
      [&](const IntrinsicCall&) { return intrinsicCost * width; },
      [&](const GatherRead&) { return addressCost + elementCost(module, expr.type); },
      [&](const NeighborRead&) { return addressCost + elementCost(module, expr.type); },
      [&](const Sample& n) {
        // reads every neighbour, then computes a weighted mean of each pair
        const double neighbours = 1 << n.position->type.width;
        return neighbours * (addressCost + elementCost(module, expr.type) + 3 * width);
      },
      [](const IndexOf&) { return 0.0; }, [](const ExtentOf&) { return 0.0; });
}

/// A function of floats that the program of a body must define, with its weight for one component. Drivers compile it for each call.
struct DefinedFunction {
  Intrinsic intrinsic;
  std::uint32_t weight;
};

// clang-format off
constexpr DefinedFunction definedFunctions[] = {
    {Intrinsic::Sin, 58},   {Intrinsic::Cos, 53},    {Intrinsic::Tan, 53},     {Intrinsic::Asin, 18},   {Intrinsic::Acos, 10},
    {Intrinsic::Atan, 13},  {Intrinsic::Atan2, 24},  {Intrinsic::AtanYX, 24},  {Intrinsic::Sinh, 22},   {Intrinsic::Cosh, 14},
    {Intrinsic::Tanh, 23},  {Intrinsic::Asinh, 34},  {Intrinsic::Acosh, 28},   {Intrinsic::Atanh, 34},  {Intrinsic::Exp, 14},
    {Intrinsic::Exp2, 10},  {Intrinsic::Log, 21},    {Intrinsic::Log2, 21},    {Intrinsic::Log10, 22},  {Intrinsic::Pow, 56},
    {Intrinsic::Hypot, 14}, {Intrinsic::Log1p, 27},  {Intrinsic::Expm1, 37},   {Intrinsic::Cbrt, 22},   {Intrinsic::Erf, 56},
    {Intrinsic::Erfc, 58},  {Intrinsic::Min, 6},     {Intrinsic::Fmin, 6},     {Intrinsic::Max, 6},     {Intrinsic::Fmax, 6},
    {Intrinsic::Clamp, 10}, {Intrinsic::Mod, 50},    {Intrinsic::Fmod, 40},    {Intrinsic::Mix, 3},     {Intrinsic::Lerp, 3},
    {Intrinsic::Smoothstep, 3}, {Intrinsic::Length, 7}, {Intrinsic::Distance, 7}, {Intrinsic::Normalize, 7},
};
// clang-format on
/// The same for an intrinsic of exact sums.
constexpr std::uint32_t exactSumWeight = 12;

bool isOfExactSums(Intrinsic intrinsic) {
  return intrinsic >= Intrinsic::ExactDigits && intrinsic <= Intrinsic::ExactRounded;
}

/// The weight of a node without its operands.
std::uint32_t weightOf(const Expr& expr) {
  if (isOperation(expr) && expr.type.isDouble()) return static_cast<std::uint32_t>(doubleCost);
  if (isOperation(expr) && expr.type.isLong()) return static_cast<std::uint32_t>(longCost);
  const auto* call = std::get_if<IntrinsicCall>(&expr.node);
  if (call == nullptr) return 1;
  if (call->args[0]->type.isDouble()) return static_cast<std::uint32_t>(doubleCost);
  if (isOfExactSums(call->intrinsic)) return 1 + exactSumWeight;
  const auto* row = std::ranges::find(definedFunctions, call->intrinsic, &DefinedFunction::intrinsic);
  const bool isDefined = row != std::end(definedFunctions) && !call->args[0]->type.isInteger();
  const ExprPtr& widest =
      *std::ranges::max_element(call->args, {}, [](const ExprPtr& arg) { return arg->type.width; });
  return 1 + (isDefined ? row->weight * widest->type.width : 0);
}

}  // namespace

std::uint32_t weightOf(const Module& module, const Kernel& kernel) {
  std::uint32_t weight = 0;
  for (const FunctionId id : functionsOf(module, kernel)) {
    const Block& body = module.functions[id].body;
    walkStmts(body, [&](const Stmt&) { ++weight; });
    walkExprs(body, [&](const Expr& expr) { weight += weightOf(expr); });
  }
  return weight;
}

std::vector<Type> planesOf(const Module& module, Type type) {
  std::vector<Type> planes;
  collectPlanes(module, type, planes);
  return planes;
}

double planeCost(Type plane) { return componentCost * plane.width * (plane.is64Bit() ? 2 : 1); }

double elementCost(const Module& module, Type type) {
  double cost = 0;
  for (const Type plane : planesOf(module, type)) cost += planeCost(plane);
  return cost;
}

CostModel::CostModel(const Module& module, const Kernel& kernel) : module_(module) {
  for (const FunctionId id : functionsOf(module, kernel))   // callees first
    functions_[id] = block(module.functions[id].body, nullptr);
  walkStmts(module.functions[kernel.entry].body,
            [&](const Stmt& stmt) { operands_[&stmt] = operands(stmt); });
}

double CostModel::run(const Block& body, const Slice& slice) const { return block(body, &slice); }

double CostModel::block(const Block& body, const Slice* slice) const {
  double cost = 0;
  for (const Stmt& stmt : body) {
    if (slice == nullptr || slice->kept.contains(&stmt)) cost += statement(stmt, slice);
  }
  return cost;
}

double CostModel::operands(const Stmt& stmt) const {
  if (const auto known = operands_.find(&stmt); known != operands_.end()) return known->second;
  double cost = 0;
  forEachOperand(stmt, [&](const ExprPtr& operand) { cost += expression(*operand); });
  return cost;
}

double CostModel::statement(const Stmt& stmt, const Slice* slice) const {
  const double once = operands(stmt);
  const auto simple = [&] { return once; };
  return match(
      stmt.node, [&](const Declare&) { return simple(); },
      [&](const Assign& n) { return once + (n.op ? n.place->type.width : 0); },
      [&](const CallStmt& n) { return once + functions_.at(n.callee); },
      [&](const If& n) { return once + block(n.then, slice) + block(n.otherwise, slice); },
      [&](const Loop& n) {
        const std::optional<std::int64_t> known = tripCount(module_, n);
        const double iterations = known ? static_cast<double>(*known) : unknownTripCount;
        return block(n.init, slice) + iterations * (once + block(n.step, slice) + block(n.body, slice));
      },
      [&](const Switch& n) {
        double cases = 0;
        for (const Case& one : n.cases) cases += block(one.body, slice);
        return once + cases;
      },
      [&](const Break&) { return simple(); }, [&](const Continue&) { return simple(); },
      [&](const Return&) { return simple(); }, [&](const Scope& n) { return block(n.body, slice); },
      [&](const Push&) { return simple(); }, [&](const Scatter&) { return simple(); },
      [](const Print&) { return 0.0; });
}

double CostModel::expression(const Expr& expr) const {
  double cost = 0;
  walkExprs(expr, [&](const Expr& inner) { cost += nodeCost(module_, inner, functions_); });
  return cost;
}

}  // namespace skc::split
