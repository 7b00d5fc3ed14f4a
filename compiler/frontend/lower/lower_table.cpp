// SPDX-License-Identifier: MIT
//
// Lowers [[table(lo, hi, n, linear)]]: checks its numbers, and that its function may have a table.
#include <bit>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include <clang/AST/DeclCXX.h>

#include "frontend/lower/module_lowering.hpp"
#include "ir/evaluate.hpp"

namespace skc::frontend {

/// The bits of one of the constants that the token editor generated.
std::uint32_t ModuleLowering::generatedNumber(const std::string& name) {
  const clang::VarDecl* variable = generatedGlobals_.at(name);
  const ir::ExprPtr value = constantValue(variable, /*inlined=*/true);
  const std::optional<std::uint32_t> bits = ir::evaluateInFloat(module_, *value, ir::Constants::LookThrough);
  if (!bits) fail(Diag::NotConstant, variable->getLocation());
  return *bits;
}

ir::TableId ModuleLowering::table(const clang::FunctionDecl* declaration, const TableSyntax& syntax) {
  constexpr std::int32_t mostIntervals = 1 << 20;   // sk::mostIntervals
  const clang::SourceLocation where = declaration->getLocation();
  const std::string name = declaration->getNameAsString();
  const bool isMember = llvm::isa<clang::CXXMethodDecl>(declaration);
  const bool takesFloat =
      declaration->getNumParams() == 1 &&
      declaration->getParamDecl(0)->getType()->isSpecificBuiltinType(clang::BuiltinType::Float);
  if (isMember || !takesFloat ||
      !declaration->getReturnType()->isSpecificBuiltinType(clang::BuiltinType::Float)) {
    fail(Diag::TableFunction, where, {name});
  }
  const auto low = std::bit_cast<float>(generatedNumber(syntax.low));
  const auto high = std::bit_cast<float>(generatedNumber(syntax.high));
  const auto intervals = static_cast<std::int32_t>(generatedNumber(syntax.intervals));
  if (!(low < high)) fail(Diag::TableRange, where, {name, fmt::format("{}", low), fmt::format("{}", high)});
  if (intervals < 1 || intervals > mostIntervals) {
    fail(Diag::TableIntervals, where, {name, std::to_string(intervals), std::to_string(mostIntervals)});
  }
  module_.tables.push_back({.name = name,
                            .scope = scopeOf(declaration),
                            .low = low,
                            .high = high,
                            .intervals = static_cast<std::uint32_t>(intervals),
                            .isCubic = syntax.isCubic});
  return static_cast<ir::TableId>(module_.tables.size() - 1);
}

}  // namespace skc::frontend
