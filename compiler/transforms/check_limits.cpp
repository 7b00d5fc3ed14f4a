// SPDX-License-Identifier: MIT
#include "transforms/check_limits.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

#include "ir/call_graph.hpp"
#include "ir/walk.hpp"
#include "split/cost.hpp"

namespace skc {

using namespace ir;

namespace {

constexpr std::size_t mostParameters = 250;   // descriptors number them with 8 bits
constexpr std::size_t mostPlanes = 250;       // and the planes of stacks
constexpr std::size_t mostReads = 120;        // far more than a pass reads on any device
constexpr std::size_t promisedVectors = 200;  // of ES 3.0's 224; the programs' own uniforms take some

/// The vectors of four that a uniform takes without packing.
std::size_t vectorsOf(const Module& module, Type type) {
  if (type.kind == Type::Kind::Array) {
    const Array& array = module.arrays[type.index];
    return array.length * vectorsOf(module, array.element);
  }
  if (type.isMatrix()) return type.width;
  if (type.is64Bit()) return (type.width + 1U) / 2;
  if (type.kind != Type::Kind::Struct) return 1;
  std::size_t vectors = 0;
  for (const StructField& field : module.structs[type.index].fields) vectors += vectorsOf(module, field.type);
  return vectors;
}

bool isRead(const KernelParam& param) {
  return param.role == ParamRole::Input || param.role == ParamRole::Gather;
}

bool isStream(const KernelParam& param) {
  return isRead(param) || param.role == ParamRole::Output || param.role == ParamRole::Accumulator ||
         param.role == ParamRole::VariableOutput || param.role == ParamRole::Scatter;
}

}  // namespace

KernelSize sizeOf(const Module& module, const Kernel& kernel) {
  KernelSize size{.parameters = kernel.params.size()};
  for (const KernelParam& param : kernel.params) {
    if (isRead(param)) ++size.reads;
    if (isStream(param)) size.planes += split::planesOf(module, param.type).size();
  }
  return size;
}

bool fits(const KernelSize& size) {
  return size.parameters <= mostParameters && size.reads <= mostReads && size.planes <= mostPlanes;
}

void checkLimits(const Module& module, Diagnostics& diagnostics) {
  for (const Kernel& kernel : module.kernels) {
    std::size_t vectors = 0;
    for (const KernelParam& param : kernel.params) {
      if (param.role == ParamRole::Uniform) vectors += vectorsOf(module, param.type);
    }
    const auto report = [&](Diag diag, std::size_t count, std::size_t most) {
      diagnostics.report(diag, kernel.loc, {kernel.name, std::to_string(count), std::to_string(most)});
    };
    const KernelSize size = sizeOf(module, kernel);
    if (size.parameters > mostParameters) report(Diag::KernelParameters, size.parameters, mostParameters);
    if (size.reads > mostReads) report(Diag::KernelReads, size.reads, mostReads);
    if (size.planes > mostPlanes) report(Diag::KernelPlanes, size.planes, mostPlanes);
    if (vectors > promisedVectors) report(Diag::UniformSize, vectors, promisedVectors);
  }
}

bool checkCombinationFits(const Module& module, const Kernel& kernel, Diagnostics& diagnostics) {
  const KernelSize size = sizeOf(module, module.kernels[*kernel.reduction->combine]);
  if (fits(size)) return true;
  const auto report = [&](std::size_t count, std::string_view what, std::size_t most) {
    diagnostics.report(Diag::CombinationSize, kernel.loc,
                       {kernel.name, std::to_string(count), std::string(what), std::to_string(most)});
  };
  if (size.parameters > mostParameters) {
    report(size.parameters, "parameters", mostParameters);
  } else if (size.reads > mostReads) {
    report(size.reads, "streams to read", mostReads);
  } else {
    report(size.planes, "members", mostPlanes);
  }
  return false;
}

namespace {

/// Operations of one kernel. Native code of a kernel with as many takes some ten seconds to compile; kernels written by hand have
/// fewer than a hundredth.
constexpr std::uint64_t mostOperations = 100'000;
/// Counts stop here, far above the limit and far below an overflow.
constexpr std::uint64_t largestCount = std::uint64_t{1} << 40;

/// Counts the expressions and statements of functions, with those of the functions that they call.
class InlinedSizes {
 public:
  explicit InlinedSizes(const Module& module) : module_(module) {}

  std::uint64_t of(const Kernel& kernel) {
    for (const FunctionId id : functionsOf(module_, kernel)) {  // callees first
      if (!known_.contains(id)) known_[id] = count(module_.functions[id].body);
    }
    return known_.at(kernel.entry);
  }

 private:
  std::uint64_t count(const Block& body) const {
    std::uint64_t count = 0;
    const auto add = [&](std::uint64_t more) { count = std::min(count + more, largestCount); };
    walkStmts(body, [&](const Stmt& stmt) {
      const auto* n = std::get_if<CallStmt>(&stmt.node);
      add(n == nullptr ? 1 : 1 + known_.at(n->callee));
    });
    walkExprs(body, [&](const Expr& expr) {
      const auto* n = std::get_if<Call>(&expr.node);
      add(n == nullptr ? 1 : 1 + known_.at(n->callee));
    });
    return count;
  }

  const Module& module_;
  std::unordered_map<FunctionId, std::uint64_t> known_;
};

}  // namespace

void checkSizes(const Module& module, Diagnostics& diagnostics) {
  InlinedSizes sizes(module);
  for (const Kernel& kernel : module.kernels) {
    const std::uint64_t size = sizes.of(kernel);
    if (size <= mostOperations) continue;
    const std::string text = size == largestCount ? "more than 10^12" : std::to_string(size);
    diagnostics.report(Diag::KernelSize, kernel.loc, {kernel.name, text, std::to_string(mostOperations)});
  }
}

}  // namespace skc
