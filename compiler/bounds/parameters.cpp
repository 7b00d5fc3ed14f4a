// SPDX-License-Identifier: MIT
//
// What the executor begins and ends with: the numbers that a kernel reads, and those that it writes.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "bounds/executor.hpp"
#include "ir/build.hpp"

namespace skc::bounds {

using namespace ir;

/// The names and types of all scalars of a value.
void Executor::nameNumbers(const std::string& name, Type type,
                           std::vector<std::pair<std::string, Scalar>>& names) const {
  constexpr std::string_view components = "xyzw";
  switch (type.kind) {
    case Type::Kind::Void: return;
    case Type::Kind::Scalar: names.emplace_back(name, type.scalar); return;
    case Type::Kind::Vector:
      for (std::size_t i = 0; i < type.width; ++i)
        names.emplace_back(name + "." + components[i], type.scalar);
      return;
    case Type::Kind::Matrix:
      for (std::size_t i = 0; i < std::size_t{type.width} * type.width; ++i)
        names.emplace_back(fmt::format("{}[{}][{}]", name, i / type.width, i % type.width), type.scalar);
      return;
    case Type::Kind::Struct:
      for (const StructField& field : module_.structs[type.index].fields)
        nameNumbers(name + "." + field.name, field.type, names);
      return;
    case Type::Kind::Array: {
      const Array& array = module_.arrays[type.index];
      for (std::uint32_t i = 0; i < array.length; ++i)
        nameNumbers(fmt::format("{}[{}]", name, i), array.element, names);
      return;
    }
  }
}

/// The node of a number that the kernel reads; one for each name.
NodeId Executor::readNumber(const std::string& name, const KernelParam& param, Scalar type) {
  if (const auto known = named_.find(name); known != named_.end()) return known->second;
  const Scalar arithmetic = arithmeticScalar(type);
  const std::optional<Interval> given = rangeOf(options_, param, name);
  Interval range = given.value_or(Interval::whole());
  NodeId id;
  if (type == Scalar::Bool) {
    // An integer that is 0 or 1.
    const Interval bits = given ? intersection(range, {0, 1}) : Interval{0, 1};
    if (bits.isEmpty())
      throw NotBounded(fmt::format("the range of the bool {} has neither 0 nor 1", name), param.loc);
    id = arithmetic_.equal(arithmetic_.read(Scalar::Int, name, bits), arithmetic_.number(Scalar::Int, 1));
  } else {
    if (!isReal(arithmetic)) range = {std::ceil(range.low), std::floor(range.high)};
    if (range.isEmpty())
      throw NotBounded(fmt::format("the range of the integer {} has no integer", name), param.loc);
    id = arithmetic_.read(arithmetic, name, range);
  }
  lacksRange_.resize(graph_.inputs().size(), false);
  if (!given && type != Scalar::Bool) lacksRange_.back() = true;
  named_.emplace(name, id);
  return id;
}

Numbers Executor::readParameter(const std::string& name, const KernelParam& param, Type type) {
  std::vector<std::pair<std::string, Scalar>> names;
  nameNumbers(name, type, names);
  Numbers numbers;
  for (const auto& [number, scalar] : names) numbers.push_back(readNumber(number, param, scalar));
  return numbers;
}

/// The values of the entry's variables when the kernel begins. Outputs are 0.
std::vector<Numbers> Executor::parameters() {
  std::vector<Numbers> values;
  for (const KernelParam& param : kernel_.params) {
    switch (param.role) {
      case ParamRole::Uniform:
      case ParamRole::Input:
      case ParamRole::Iterator:
      case ParamRole::Spec: values.push_back(readParameter(param.name, param, param.type)); break;
      case ParamRole::Output: values.emplace_back(size(param.type), arithmetic_.number(0)); break;
      case ParamRole::Accumulator: {
        // Any number: a sum does not depend on it, and the fold of the elements is bounded elsewhere.
        std::vector<std::pair<std::string, Scalar>> names;
        nameNumbers(param.name, param.type, names);
        Numbers numbers;
        for (const auto& [name, type] : names) {
          Input input;
          input.name = name;
          input.range = Interval::point(0);
          numbers.push_back(graph_.input(std::move(input), {}));
        }
        lacksRange_.resize(graph_.inputs().size(), false);
        values.push_back(std::move(numbers));
        break;
      }
      case ParamRole::Gather:
      case ParamRole::VariableOutput:
      case ParamRole::Scatter: values.emplace_back(); break;
    }
  }
  return values;
}

void Executor::addOutputs(KernelGraph& result, const std::vector<Numbers>& before,
                          const std::vector<Numbers>& after) {
  for (std::uint32_t p = 0; p < kernel_.params.size(); ++p) {
    const KernelParam& param = kernel_.params[p];
    if (param.role != ParamRole::Output && param.role != ParamRole::Accumulator) continue;
    std::vector<std::pair<std::string, Scalar>> names;
    nameNumbers(param.name, param.type, names);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Scalar type = names[i].second;
      if (!isReal(arithmeticScalar(type))) continue;
      const bool isAccumulator = param.role == ParamRole::Accumulator;
      const NodeId node = after[p][i];  // of a storage type: converted when it was assigned
      const bool isFinal = isAccumulator || isNarrow(type);
      result.outputs.push_back({names[i].first, p, type, isFinal ? node : arithmetic_.stored(type, node),
                                isAccumulator, isAccumulator ? before[p][i] : noNode});
    }
  }
}

KernelGraph Executor::run() {
  KernelGraph result;
  const std::vector<Numbers> before = parameters();
  std::vector<std::optional<std::uint32_t>> streams;
  for (std::uint32_t p = 0; p < kernel_.params.size(); ++p) streams.emplace_back(p);
  const Path end = call(kernel_.entry, before, std::move(streams), kernel_.loc);
  addOutputs(result, before, end.variables);
  for (OutputNumber& number : appended_) result.outputs.push_back(std::move(number));
  result.graph = std::move(graph_);
  result.lacksRange = std::move(lacksRange_);
  result.lacksRange.resize(result.graph.inputs().size(), false);
  result.origins = std::move(origins_);
  result.origins.resize(result.graph.size());
  return result;
}

}  // namespace skc::bounds
