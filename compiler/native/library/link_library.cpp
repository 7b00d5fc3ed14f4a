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

/// What float_functions.sk defines, under the spelling of the intrinsic, for scalars.
constexpr Intrinsic ofFloats[] = {
    Intrinsic::Sin,   Intrinsic::Cos,   Intrinsic::Tan,    Intrinsic::Asin,  Intrinsic::Acos,
    Intrinsic::Atan,  Intrinsic::Sinh,  Intrinsic::Cosh,   Intrinsic::Tanh,  Intrinsic::Asinh,
    Intrinsic::Acosh, Intrinsic::Atanh, Intrinsic::AtanYX, Intrinsic::Atan2, Intrinsic::Pow,
    Intrinsic::Exp,   Intrinsic::Exp2,  Intrinsic::Log,    Intrinsic::Log2,  Intrinsic::Log10,
    Intrinsic::Fmod,  Intrinsic::Mod,
};

/// What exact_sums.sk defines, for all arguments together.
struct Named {
  Intrinsic intrinsic;
  std::string_view function;
};
constexpr Named ofExactSums[] = {
    {Intrinsic::ExactDigits, "exact_digits"},
    {Intrinsic::ExactFlags, "exact_flags"},
    {Intrinsic::ExactProductDigits, "exact_product_digits"},
    {Intrinsic::ExactProductFlags, "exact_product_flags"},
    {Intrinsic::ExactCarry, "exact_carry"},
    {Intrinsic::ExactSettled, "exact_settled"},
    {Intrinsic::ExactRounded, "exact_rounded"},
};

/// The intrinsics that kernels call: of floats, and of exact sums.
struct Wanted {
  std::set<Intrinsic> ofFloats;
  std::vector<Named> ofExactSums;
};
Wanted wantedBy(const Module& module) {
  std::set<Intrinsic> all;
  for (const Kernel& kernel : module.kernels) {
    for (const FunctionId id : functionsOf(module, kernel)) {
      walkExprs(module.functions[id].body, [&](const Expr& expr) {
        const auto* call = std::get_if<IntrinsicCall>(&expr.node);
        if (call == nullptr) return;
        const bool isOfFloats = std::ranges::find(ofFloats, call->intrinsic) != std::end(ofFloats);
        if (!isOfFloats || call->args.front()->type.isFloat()) all.insert(call->intrinsic);
      });
    }
  }
  Wanted wanted;
  for (const Intrinsic intrinsic : ofFloats) {
    if (all.contains(intrinsic)) wanted.ofFloats.insert(intrinsic);
  }
  for (const Named& named : ofExactSums) {
    if (all.contains(named.intrinsic)) wanted.ofExactSums.push_back(named);
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
  const Wanted wanted = wantedBy(module);
  const auto import = [&](FunctionImporter& importer, const Module& library, auto&& isWanted) {
    const auto found = std::ranges::find_if(library.functions, isWanted);
    assert(found != library.functions.end());
    return importer.import(static_cast<FunctionId>(found - library.functions.begin()));
  };
  if (!wanted.ofFloats.empty()) {
    const Module library = compile("float_functions.sk", floatFunctions());
    FunctionImporter importer(module, library);
    for (const Intrinsic intrinsic : wanted.ofFloats) {
      linked.add(intrinsic, Scalar::Float, import(importer, library, [&](const Function& function) {
                   return implements(function, intrinsic);
                 }));
    }
  }
  if (!wanted.ofExactSums.empty()) {
    const Module library = compile("exact_sums.sk", exactSums());
    FunctionImporter importer(module, library);
    for (const Named& named : wanted.ofExactSums) {
      const FunctionId function = import(importer, library, [&](const Function& f) { return f.name == named.function; });
      linked.add(named.intrinsic, module.functions[function].variables[0].type.scalar, function);
    }
  }
  return linked;
}

}  // namespace skc::native
