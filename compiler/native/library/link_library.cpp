// SPDX-License-Identifier: MIT
#include "native/library/link_library.hpp"

#include <algorithm>
#include <cassert>
#include <span>
#include <vector>

#include "ir/reach.hpp"
#include "ir/walk.hpp"
#include "native/library/import_function.hpp"
#include "native/library/sources.hpp"

namespace skc::native {
namespace {

using namespace ir;

/// An intrinsic, and the name of the library's function that computes it.
struct Row {
  Intrinsic intrinsic;
  std::string_view function;
};

// Functions of doubles do without the last two.
constexpr Row functionsOfReals[] = {
    {Intrinsic::Sin, "sin"},     {Intrinsic::Cos, "cos"},     {Intrinsic::Tan, "tan"},
    {Intrinsic::Asin, "asin"},   {Intrinsic::Acos, "acos"},   {Intrinsic::Atan, "atan"},
    {Intrinsic::Sinh, "sinh"},   {Intrinsic::Cosh, "cosh"},   {Intrinsic::Tanh, "tanh"},
    {Intrinsic::Asinh, "asinh"}, {Intrinsic::Acosh, "acosh"}, {Intrinsic::Atanh, "atanh"},
    {Intrinsic::AtanYX, "atan"}, {Intrinsic::Atan2, "atan2"}, {Intrinsic::Pow, "pow"},
    {Intrinsic::Exp, "exp"},     {Intrinsic::Exp2, "exp2"},   {Intrinsic::Log, "log"},
    {Intrinsic::Log2, "log2"},   {Intrinsic::Log10, "log10"}, {Intrinsic::Fmod, "fmod"},
    {Intrinsic::Mod, "mod"},
};
constexpr Row functionsOfExactSums[] = {
    {Intrinsic::ExactDigits, "exact_digits"},
    {Intrinsic::ExactFlags, "exact_flags"},
    {Intrinsic::ExactProductDigits, "exact_product_digits"},
    {Intrinsic::ExactProductFlags, "exact_product_flags"},
    {Intrinsic::ExactCarry, "exact_carry"},
    {Intrinsic::ExactSettled, "exact_settled"},
    {Intrinsic::ExactRounded, "exact_rounded"},
};

struct Library {
  std::string_view file;
  std::string_view (*text)();
  std::span<const Row> rows;
  std::optional<Scalar> scalar;   ///< of the first argument, if intrinsics of others are not the library's
};
const Library libraries[] = {
    {"float_functions.sk", floatFunctions, functionsOfReals, Scalar::Float},
    {"double_functions.sk", doubleFunctions, std::span(functionsOfReals).first(20), Scalar::Double},
    {"exact_sums.sk", exactSums, functionsOfExactSums, std::nullopt},
};

/// Rows whose intrinsics kernels call, with arguments that the library is for.
std::vector<Row> wantedRows(const Library& library, const Module& module) {
  std::vector<bool> isWanted(library.rows.size());
  const auto look = [&](const Expr& expr) {
    const auto* call = std::get_if<IntrinsicCall>(&expr.node);
    if (call == nullptr) return;
    const auto row = std::ranges::find(library.rows, call->intrinsic, &Row::intrinsic);
    if (row == library.rows.end()) return;
    if (!library.scalar || call->args.front()->type.scalar == *library.scalar)
      isWanted[static_cast<std::size_t>(row - library.rows.begin())] = true;
  };
  for (const Kernel& kernel : module.kernels) {
    for (const FunctionId id : functionsOf(module, kernel)) walkExprs(module.functions[id].body, look);
  }
  std::vector<Row> wanted;
  for (std::size_t i = 0; i < isWanted.size(); ++i) {
    if (isWanted[i]) wanted.push_back(library.rows[i]);
  }
  return wanted;
}

/// By name and types, since `atan` is two intrinsics.
bool implements(const Function& function, const Row& row) {
  std::vector<Type> parameters;
  for (std::uint32_t i = 0; i < function.parameterCount; ++i)
    parameters.push_back(function.variables[i].type);
  return function.name == row.function && resultType(row.intrinsic, parameters) == function.result;
}

FunctionId implementation(const Module& library, const Row& row) {
  const auto found = std::ranges::find_if(
      library.functions, [&](const Function& function) { return implements(function, row); });
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
    const std::vector<Row> wanted = wantedRows(library, module);
    if (wanted.empty()) continue;
    const Module compiled = compile(library.file, library.text());
    FunctionImporter importer(module, compiled);
    for (const Row& row : wanted) {
      const FunctionId function = importer.import(implementation(compiled, row));
      linked.add(row.intrinsic, module.functions[function].variables[0].type.scalar, function);
    }
  }
  return linked;
}

}  // namespace skc::native
