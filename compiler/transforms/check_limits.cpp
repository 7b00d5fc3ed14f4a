// SPDX-License-Identifier: MIT
#include "transforms/check_limits.hpp"

#include <cstddef>
#include <string>
#include <string_view>

#include "split/cost.hpp"

namespace skc {
namespace {

using namespace ir;

constexpr std::size_t mostParameters = 250;   // descriptors number them with 8 bits
constexpr std::size_t mostPlanes = 250;       // and the planes of bundles
constexpr std::size_t mostReads = 120;        // far more than a pass reads on any device
constexpr std::size_t promisedVectors = 200;  // of ES 3.0's 224; the programs' own uniforms take some

/// The vectors of four that a uniform takes without packing.
std::size_t vectorsOf(const Module& module, Type type) {
  if (type.kind == Type::Kind::Array) {
    const Array& array = module.arrays[type.index];
    return array.length * vectorsOf(module, array.element);
  }
  if (type.isMatrix()) return type.width;
  if (type.isDouble()) return (type.width + 1U) / 2;
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

}  // namespace skc
