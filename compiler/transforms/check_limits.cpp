// SPDX-License-Identifier: MIT
#include "transforms/check_limits.hpp"

#include <cstddef>
#include <string>

#include "split/cost.hpp"

namespace skc {
namespace {

using namespace ir;

constexpr std::size_t mostParameters = 250;   // descriptors number them with 8 bits
constexpr std::size_t mostPlanes = 250;       // and the planes of bundles
constexpr std::size_t mostReads = 120;        // a program's key has 4 bits per stream that is read
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

void checkLimits(const Module& module, Diagnostics& diagnostics) {
  for (const Kernel& kernel : module.kernels) {
    std::size_t reads = 0, planes = 0, vectors = 0;
    for (const KernelParam& param : kernel.params) {
      if (isRead(param)) ++reads;
      if (param.role == ParamRole::Uniform) vectors += vectorsOf(module, param.type);
      if (isStream(param)) planes += split::planesOf(module, param.type).size();
    }
    const auto require = [&](Diag diag, std::size_t count, std::size_t most) {
      if (count <= most) return;
      diagnostics.report(diag, kernel.loc, {kernel.name, std::to_string(count), std::to_string(most)});
    };
    require(Diag::KernelParameters, kernel.params.size(), mostParameters);
    require(Diag::KernelReads, reads, mostReads);
    require(Diag::KernelPlanes, planes, mostPlanes);
    require(Diag::UniformSize, vectors, promisedVectors);
  }
}

}  // namespace skc
