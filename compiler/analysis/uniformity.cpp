// SPDX-License-Identifier: MIT
#include "analysis/uniformity.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

#include "analysis/divergence_walk.hpp"
#include "ir/call_graph.hpp"

namespace skc::analysis {

using namespace ir;

namespace {

/// Replaces missing shapes: a leaf that nothing is assigned to is uniform.
std::vector<Shape> known(const LeafShapes& leaves) {
  std::vector<Shape> shapes;
  for (const LeafShape leaf : leaves) shapes.push_back(leaf.value_or(Shape::Uniform));
  return shapes;
}

void makeUniform(LeafShapes& leaves) {
  for (LeafShape& leaf : leaves) leaf = leaf.value_or(Shape::Uniform);
}

/// The shapes of the entry's variables at its start.
LeafShape atEntry(const Kernel& kernel, VarId var, Axis axis) {
  // predicate's mask: true in the lanes that have an element, the same in all rows
  if (var >= kernel.params.size()) return axis == Axis::X ? Shape::Varying : Shape::Uniform;
  switch (kernel.params[var].role) {
    case ParamRole::Input:
    case ParamRole::Iterator:
    case ParamRole::Accumulator: return Shape::Varying;
    case ParamRole::Output: return std::nullopt;
    case ParamRole::Uniform:
    case ParamRole::Gather:
    case ParamRole::VariableOutput:
    case ParamRole::Scatter:
    case ParamRole::Spec: break;
  }
  return Shape::Uniform;
}

}  // namespace

Uniformity::Uniformity(const Module& module, const Kernel& kernel, Axis axis)
    : module_(module), kernel_(kernel), axis_(axis) {
  const std::vector<FunctionId> functions = functionsOf(module, kernel);
  for (const FunctionId id : functions) {
    const Function& function = module.functions[id];
    FunctionShapes& own = shapes_[id];
    for (VarId i = 0; i < function.variables.size(); ++i) {
      const bool isParameter = id == kernel.entry && i < function.parameterCount;
      own.variables.emplace_back(leafCount(module, function.variables[i].type),
                                 isParameter ? atEntry(kernel, i, axis) : std::nullopt);
    }
    own.result.resize(leafCount(module, function.result));
    facts_[id] = {};
  }
  propagate(functions);
  // Variables that are never assigned still have no shape, nor have values computed from them alone.
  for (auto& [id, own] : shapes_) {
    for (LeafShapes& leaves : own.variables) makeUniform(leaves);
    makeUniform(own.result);
  }
  propagate(functions);
  for (const auto& [id, own] : shapes_) {
    for (const LeafShapes& leaves : own.variables) facts_[id].variables.push_back(known(leaves));
    facts_[id].result = known(own.result);
  }
}

void Uniformity::propagate(const std::vector<FunctionId>& functions) {
  // results flow from callees to callers, arguments the other way: each round goes both ways
  bool isNew = true;
  const auto walk = [&](FunctionId id) { isNew = DivergenceWalk(*this, id).run() || isNew; };
  while (std::exchange(isNew, false)) {
    std::ranges::for_each(functions, walk);
    if (isNew) std::ranges::for_each(std::views::reverse(functions), walk);
  }
}

std::span<const Shape> Uniformity::of(FunctionId function, VarId var) const {
  return at(function).variables[var];
}

std::span<const Shape> Uniformity::resultOf(FunctionId function) const { return at(function).result; }

std::vector<Shape> Uniformity::leavesOf(FunctionId function, const Expr& expr) const {
  return known(ExprShapes(module_, kernel_, shapes_, axis_).of(function, expr));
}

Shape Uniformity::of(FunctionId function, const Expr& expr) const {
  const LeafShape all = join(ExprShapes(module_, kernel_, shapes_, axis_).of(function, expr));
  const bool isPart = all == Shape::Consecutive && !expr.type.isScalar();
  return isPart ? Shape::Varying : all.value_or(Shape::Uniform);
}

bool Uniformity::diverges(FunctionId function, const Stmt& stmt) const {
  return at(function).divergent.contains(&stmt);
}

bool Uniformity::skips(FunctionId function, const Stmt& loop) const {
  return at(function).skipping.contains(&loop);
}

bool Uniformity::blends(FunctionId function, const Stmt& stmt, VarId var) const {
  return at(function).blended.contains({&stmt, var});
}

}  // namespace skc::analysis
