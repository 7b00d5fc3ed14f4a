// SPDX-License-Identifier: MIT
//
// Lowers `stream` declarations: element types and extents. An extent that is a single name is a constant if
// the name was declared as one before, and otherwise an argument of the struct that holds the streams.
// Lowers [[table(lo, hi, n, linear)]]: checks its numbers, and that its function may have a table.
#include <clang/AST/APValue.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include <clang/AST/ASTContext.h>
#include <clang/AST/DeclCXX.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Sema/Lookup.h>
#include <clang/Sema/Sema.h>
#include <fmt/format.h>

#include "frontend/lower/module_lowering.hpp"
#include "ir/evaluate.hpp"

namespace skc::frontend {

using clang::SourceLocation;

namespace {

/// The value of an integer constant.
std::optional<std::int64_t> valueOf(const clang::ValueDecl* declaration) {
  llvm::APSInt value;
  if (const auto* enumerator = llvm::dyn_cast<clang::EnumConstantDecl>(declaration)) {
    value = enumerator->getInitVal();
  } else {
    const auto* variable = llvm::cast<clang::VarDecl>(declaration);
    if (!variable->getType()->isIntegralOrEnumerationType() || !variable->getType().isConstQualified() ||
        !variable->getAnyInitializer(variable)) {
      return std::nullopt;
    }
    const clang::APValue* known = variable->evaluateValue();
    if (!known || !known->isInt()) return std::nullopt;
    value = known->getInt();
  }
  return value.isRepresentableByInt64() ? std::optional(value.getExtValue()) : std::nullopt;
}

}  // namespace

void ModuleLowering::stream(const clang::VarDecl* declaration, const StreamSyntax& syntax) {
  const SourceLocation where = declaration->getLocation();
  ir::DeclaredStream entry;
  entry.name = declaration->getNameAsString();
  if (declaration->getPreviousDecl()) fail(Diag::StreamTwice, where, {entry.name});
  entry.scope = scopeOf(declaration);
  entry.type = type(declaration->getType(), where);
  checkElement(entry.type, entry.name, where);
  entry.loc = loc(where);
  for (const ExtentSyntax& extent : syntax.extents) {
    entry.extents.push_back(streamExtent(extent, declaration));
  }
  module_.streams.push_back(std::move(entry));
}

ir::DeclaredExtent ModuleLowering::streamExtent(const ExtentSyntax& syntax, const clang::VarDecl* stream) {
  const clang::ValueDecl* constant =
      syntax.name ? visibleValue(stream, syntax.name) : generatedGlobals_.at(syntax.constant);
  if (!constant) return {syntax.name->getName().str(), 0};
  const bool isStream = syntax_.stream(constant->getLocation()) != nullptr;
  if (syntax.name && !isStream &&
      sources().isBeforeInTranslationUnit(syntax.location, constant->getLocation())) {
    fail(Diag::StreamExtentLater, syntax.location, {std::string_view(syntax.name->getName())});
  }
  const std::string name = stream->getNameAsString();
  const std::optional<std::int64_t> value = valueOf(constant);
  if (!value) fail(Diag::StreamExtentKind, syntax.location, {name});
  if (*value < 1) fail(Diag::StreamExtentRange, syntax.location, {name, std::to_string(*value)});
  return {{}, *value};
}

/// The variable or enumerator that a name refers to at a stream's declaration; null if there is none.
const clang::ValueDecl* ModuleLowering::visibleValue(const clang::VarDecl* stream,
                                                     const clang::IdentifierInfo* name) {
  // Sema follows using directives, but wants a context that it can modify
  for (auto* scope = const_cast<clang::DeclContext*>(stream->getDeclContext()); scope;
       scope = scope->getParent()) {
    clang::LookupResult found(sema_, clang::DeclarationName(name), stream->getLocation(),
                              clang::Sema::LookupOrdinaryName);
    found.suppressDiagnostics();
    if (!sema_.LookupQualifiedName(found, scope)) continue;
    const clang::NamedDecl* first = (*found.begin())->getUnderlyingDecl();
    const bool isValue = llvm::isa<clang::VarDecl>(first) || llvm::isa<clang::EnumConstantDecl>(first);
    return isValue ? llvm::cast<clang::ValueDecl>(first) : nullptr;
  }
  return nullptr;
}

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
