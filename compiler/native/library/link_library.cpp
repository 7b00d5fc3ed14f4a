// SPDX-License-Identifier: MIT
#include "native/library/link_library.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <set>
#include <vector>

#include "ir/reach.hpp"
#include "ir/walk.hpp"
#include "native/library/import_function.hpp"
#include "native/library/sources.hpp"

namespace skc::native {
namespace {

using namespace ir;

/// What float_functions.sk defines, under the spelling of the intrinsic.
constexpr Intrinsic ofFloats[] = {
    Intrinsic::Sin,   Intrinsic::Cos,   Intrinsic::Tan,    Intrinsic::Asin,  Intrinsic::Acos,
    Intrinsic::Atan,  Intrinsic::Sinh,  Intrinsic::Cosh,   Intrinsic::Tanh,  Intrinsic::Asinh,
    Intrinsic::Acosh, Intrinsic::Atanh, Intrinsic::AtanYX, Intrinsic::Atan2, Intrinsic::Pow,
    Intrinsic::Exp,   Intrinsic::Exp2,  Intrinsic::Log,    Intrinsic::Log2,  Intrinsic::Log10,
    Intrinsic::Fmod,  Intrinsic::Mod,
};

/// Those of the intrinsics that kernels call with floats.
std::set<Intrinsic> wantedOfFloats(const Module& module) {
  std::set<Intrinsic> wanted;
  for (const Kernel& kernel : module.kernels) {
    for (const FunctionId id : functionsOf(module, kernel)) {
      walkExprs(module.functions[id].body, [&](const Expr& expr) {
        const auto* call = std::get_if<IntrinsicCall>(&expr.node);
        if (call == nullptr || !call->args.front()->type.isFloat()) return;
        if (std::ranges::find(ofFloats, call->intrinsic) != std::end(ofFloats))
          wanted.insert(call->intrinsic);
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
  const std::set<Intrinsic> wanted = wantedOfFloats(module);
  if (wanted.empty()) return linked;
  const Module library = compile("float_functions.sk", floatFunctions());
  FunctionImporter importer(module, library);
  for (const Intrinsic intrinsic : wanted) {
    const auto found = std::ranges::find_if(
        library.functions, [&](const Function& function) { return implements(function, intrinsic); });
    assert(found != library.functions.end());
    const auto id = static_cast<FunctionId>(found - library.functions.begin());
    linked.add(intrinsic, Scalar::Float, importer.import(id));
  }
  return linked;
}

}  // namespace skc::native
