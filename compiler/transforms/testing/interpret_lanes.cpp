// SPDX-License-Identifier: MIT
#include "transforms/testing/interpret_lanes.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "analysis/shapes.hpp"
#include "ir/build.hpp"
#include "ir/scalar_operations.hpp"

namespace skc {

using namespace ir;

namespace {

class LaneValues {
 public:
  LaneValues(const Module& module, const Lanes& lanes)
      : module_(module), shapes_(lanes.shapes), lanes_(lanes.count) {}

  /// A variable's value before its first assignment: different in each lane, if the analysis allows that.
  Numbers unassigned(FunctionId id, VarId var) const {
    const Type type = module_.functions[id].variables[var].type;
    std::vector<std::size_t> leaves;
    addLeaves(type, 0, leaves);
    Numbers value;
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
      for (const std::size_t leaf : leaves) {
        const bool varies = shapes_ != nullptr && shapes_->of(id, var)[leaf] == analysis::Shape::Varying;
        const double number = varies ? 100 + static_cast<double>(lane) : 77;
        value.push_back(type.isBool() ? (varies ? static_cast<double>(lane % 2) : 1) : number);
      }
    }
    return value;
  }

  /// Arrays may contain unassigned elements, so they are not checked.
  void check(FunctionId id, VarId var, const Numbers& value) const {
    const Variable& variable = module_.functions[id].variables[var];
    if (shapes_ == nullptr || variable.role == VarRole::AppendOutput || !variable.type.isArithmetic()) return;
    const auto leaves = shapes_->of(id, var);
    for (std::size_t i = 0; i < leaves.size() * lanes_; ++i) {
      const std::size_t lane = i / leaves.size();
      const analysis::Shape shape = leaves[i % leaves.size()];
      double wanted = value.at(i % leaves.size());
      if (shape == analysis::Shape::Consecutive)
        wanted = wrapped(variable.type.scalar,
                         static_cast<std::int64_t>(wanted) + static_cast<std::int64_t>(lane));
      const bool isAsWanted = value.at(i) == wanted || (std::isnan(value[i]) && std::isnan(wanted));
      if (shape != analysis::Shape::Varying && !isAsWanted)
        throw std::runtime_error("'" + variable.name + "' has another shape");
    }
  }

 private:
  /// For each scalar of a value, its leaf in the analysis.
  void addLeaves(Type type, std::size_t first, std::vector<std::size_t>& leaves) const {
    if (type.kind == Type::Kind::Struct) {
      const std::vector<StructField>& fields = module_.structs[type.index].fields;
      for (std::uint32_t i = 0; i < fields.size(); ++i)
        addLeaves(fields[i].type, first + analysis::firstLeaf(module_, type, i), leaves);
    } else if (type.kind == Type::Kind::Array) {
      const Array& array = module_.arrays[type.index];
      for (std::uint32_t i = 0; i < array.length; ++i) addLeaves(array.element, first, leaves);
    } else {
      for (std::size_t i = 0; i < scalarCount(module_, type); ++i) leaves.push_back(first + i);
    }
  }

  const Module& module_;
  const analysis::Uniformity* shapes_;
  std::size_t lanes_;
};

}  // namespace

LanesResult interpretLanes(const Module& module, FunctionId id, std::vector<Numbers> arguments,
                           const Lanes& lanes) {
  LanesResult result{{}, std::vector<Numbers>(lanes.count)};
  const LaneValues values(module, lanes);
  const InterpretedLanes interpreted = {
      .count = lanes.count,
      .inFull = lanes.inFull,
      .unassigned = [&](FunctionId f, VarId var) { return values.unassigned(f, var); },
      .assigned = [&](FunctionId f, VarId var, const Numbers& value) { values.check(f, var, value); },
      .pushed = [&](std::size_t lane, double value) { result.pushed[lane].push_back(value); }};
  const InterpretedStreams streams = {.read = {},
                                      .index = {static_cast<std::int64_t>(lanes.firstIndex), 3, 0, 0}};
  int steps = 100'000'000;
  std::optional<std::vector<Numbers>> ends =
      interpret(module, id, std::move(arguments), streams, steps, interpreted);
  if (!ends) throw std::runtime_error("control flow diverges, does not end, or has no value");
  result.parameters = std::move(*ends);
  return result;
}

}  // namespace skc
