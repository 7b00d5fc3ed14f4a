// SPDX-License-Identifier: MIT
#include "native/library/link_library.hpp"

#include <algorithm>
#include <cassert>
#include <set>
#include <span>
#include <vector>

#include "ir/reach.hpp"
#include "ir/walk.hpp"
#include "native/library/import_function.hpp"
#include "native/library/sources.hpp"

namespace skc::native {
namespace {

using namespace ir;

/// What both files define, under the spelling of the intrinsic.
#define SKC_TRANSCENDENTAL_INTRINSICS                                                                \
  Intrinsic::Sin, Intrinsic::Cos, Intrinsic::Tan, Intrinsic::Asin, Intrinsic::Acos, Intrinsic::Atan, \
      Intrinsic::Sinh, Intrinsic::Cosh, Intrinsic::Tanh, Intrinsic::Asinh, Intrinsic::Acosh,         \
      Intrinsic::Atanh, Intrinsic::AtanYX, Intrinsic::Atan2, Intrinsic::Pow, Intrinsic::Exp,         \
      Intrinsic::Exp2, Intrinsic::Log, Intrinsic::Log2, Intrinsic::Log10
constexpr Intrinsic ofFloats[] = {SKC_TRANSCENDENTAL_INTRINSICS, Intrinsic::Fmod, Intrinsic::Mod};
constexpr Intrinsic ofDoubles[] = {SKC_TRANSCENDENTAL_INTRINSICS};
#undef SKC_TRANSCENDENTAL_INTRINSICS

struct Library {
  Scalar scalar;   ///< of all arguments
  std::string_view file;
  std::string_view (*text)();
  std::span<const Intrinsic> intrinsics;
};
constexpr Library libraries[] = {{Scalar::Float, "float_functions.sk", floatFunctions, ofFloats},
                                 {Scalar::Double, "double_functions.sk", doubleFunctions, ofDoubles}};

/// Those of a library's intrinsics that kernels call with its scalar.
std::set<Intrinsic> wantedOf(const Library& library, const Module& module) {
  std::set<Intrinsic> wanted;
  for (const Kernel& kernel : module.kernels) {
    for (const FunctionId id : functionsOf(module, kernel)) {
      walkExprs(module.functions[id].body, [&](const Expr& expr) {
        const auto* call = std::get_if<IntrinsicCall>(&expr.node);
        if (call == nullptr ||
            std::ranges::find(library.intrinsics, call->intrinsic) == library.intrinsics.end())
          return;
        if (call->args.front()->type.scalar == library.scalar) wanted.insert(call->intrinsic);
      });
    }
  }
  return wanted;
}

/// True for `float atan(float, float)` if the intrinsic is AtanYX.
bool implements(const Function& function, Intrinsic intrinsic) {
  std::vector<Type> parameters;
  for (std::uint32_t i = 0; i < function.parameterCount; ++i)
    parameters.push_back(function.variables[i].type);
  return function.name == row(intrinsic).spelling && resultType(intrinsic, parameters) == function.result;
}

FunctionId implementation(const Module& library, Intrinsic intrinsic) {
  const auto found = std::ranges::find_if(
      library.functions, [&](const Function& function) { return implements(function, intrinsic); });
  assert(found != library.functions.end());
  return static_cast<FunctionId>(found - library.functions.begin());
}

}  // namespace

std::optional<FunctionId> LinkedFunctions::find(Intrinsic intrinsic, Scalar scalar) const {
  const auto found = functions_.find({intrinsic, scalar});
  return found == functions_.end() ? std::nullopt : std::optional(found->second);
}

void LinkedFunctions::add(Intrinsic intrinsic, Scalar scalar, FunctionId function) {
  functions_[{intrinsic, scalar}] = function;
}

LinkedFunctions linkLibrary(Module& module, const CompileLibrary& compile) {
  LinkedFunctions linked;
  for (const Library& library : libraries) {
    const std::set<Intrinsic> wanted = wantedOf(library, module);
    if (wanted.empty()) continue;
    const Module compiled = compile(library.file, library.text());
    FunctionImporter importer(module, compiled);
    for (const Intrinsic intrinsic : wanted)
      linked.add(intrinsic, library.scalar, importer.import(implementation(compiled, intrinsic)));
  }
  return linked;
}

}  // namespace skc::native
