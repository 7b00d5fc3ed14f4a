// SPDX-License-Identifier: MIT
#include "frontend/lower/bundles.hpp"

#include <algorithm>

#include <clang/AST/DeclCXX.h>
#include <clang/AST/ExprCXX.h>

#include "frontend/prelude.hpp"

namespace skc::frontend {

const clang::Expr* withoutCopies(const clang::Expr* e) {
  while (true) {
    e = e->IgnoreParenImpCasts();
    if (const auto* construct = llvm::dyn_cast<clang::CXXConstructExpr>(e);
        construct && construct->getNumArgs() == 1) {
      e = construct->getArg(0);
    } else if (const auto* temporary = llvm::dyn_cast<clang::MaterializeTemporaryExpr>(e)) {
      e = temporary->getSubExpr();
    } else {
      return e;
    }
  }
}

const clang::Expr* argumentFor(const clang::CallExpr* call, const clang::FunctionDecl* callee,
                               const clang::ParmVarDecl* parameter) {
  const auto* method = llvm::dyn_cast<clang::CXXMethodDecl>(callee);
  const bool startsWithObject =
      llvm::isa<clang::CXXOperatorCallExpr>(call) && method != nullptr && method->isInstance();
  if (parameter != nullptr)
    return call->getArg(parameter->getFunctionScopeIndex() + (startsWithObject ? 1 : 0));
  if (startsWithObject) return call->getArg(0);
  return llvm::cast<clang::CXXMemberCallExpr>(call)->getImplicitObjectArgument();
}

const clang::FieldDecl* Bundles::reasonFor(const clang::CXXRecordDecl* record) {
  record = record->getDefinition();
  if (record == nullptr) return nullptr;
  const auto [known, isNew] = reasons_.emplace(record, nullptr);
  if (!isNew) return known->second;
  for (const clang::FieldDecl* field : record->fields()) {
    const clang::CXXRecordDecl* type = field->getType()->getAsCXXRecordDecl();
    const ParamSyntax* syntax = syntax_.param(field->getLocation());
    const bool isParameter = gatherRank(type) != 0 || (syntax && syntax->role == ir::ParamRole::Spec);
    if (!isParameter && (type == nullptr || reasonFor(type) == nullptr)) continue;
    return reasons_[record] = field;
  }
  return nullptr;
}

const clang::CXXRecordDecl* Bundles::bundle(clang::QualType type) {
  const clang::CXXRecordDecl* record = type.getNonReferenceType()->getAsCXXRecordDecl();
  return record != nullptr && reasonFor(record) != nullptr ? record->getDefinition() : nullptr;
}

/// False for one that is wrongly declared as an element or an output.
bool Bundles::isBundleParameter(const clang::ParmVarDecl* parameter) {
  const ParamSyntax* syntax = syntax_.param(parameter->getLocation());
  return isBundle(parameter->getType()) && (syntax == nullptr || syntax->role == ir::ParamRole::Uniform);
}

std::optional<Bundles::Place> Bundles::placeOf(const clang::Expr* e) {
  e = withoutCopies(e);
  if (const auto* reference = llvm::dyn_cast<clang::DeclRefExpr>(e)) {
    const auto* parameter = llvm::dyn_cast<clang::ParmVarDecl>(reference->getDecl());
    if (parameter == nullptr || !isBundleParameter(parameter)) return std::nullopt;
    return Place{parameter, {}};
  }
  if (llvm::isa<clang::CXXThisExpr>(e)) {
    if (!isBundle(e->getType()->getPointeeType())) return std::nullopt;
    return Place{nullptr, {}};
  }
  if (const auto* object = llvm::dyn_cast<clang::UnaryOperator>(e);  // *this
      object != nullptr && object->getOpcode() == clang::UO_Deref) {
    return placeOf(object->getSubExpr());
  }
  const auto* member = llvm::dyn_cast<clang::MemberExpr>(e);
  const auto* field = member ? llvm::dyn_cast<clang::FieldDecl>(member->getMemberDecl()) : nullptr;
  if (field == nullptr) return std::nullopt;
  const auto* record = llvm::dyn_cast<clang::CXXRecordDecl>(field->getParent());
  if (record == nullptr || reasonFor(record) == nullptr) return std::nullopt;
  std::optional<Place> place = placeOf(member->getBase());
  if (place) place->path.push_back(field);
  return place;
}

std::vector<Bundles::Source> Bundles::parametersOf(const clang::FunctionDecl* definition) {
  std::vector<Source> sources;
  const auto add = [&](const clang::ParmVarDecl* parameter, bool isBundle) {
    if (!isBundle) return sources.push_back({parameter, {}});
    for (const Path& path : read(definition, parameter)) sources.push_back({parameter, path});
  };
  const auto* method = llvm::dyn_cast<clang::CXXMethodDecl>(definition);
  if (method && method->isInstance()) add(nullptr, isBundle(method->getFunctionObjectParameterType()));
  for (const clang::ParmVarDecl* parameter : definition->parameters())
    add(parameter, isBundleParameter(parameter));
  return sources;
}

const std::vector<Bundles::Path>& Bundles::read(const clang::FunctionDecl* definition,
                                                const clang::ParmVarDecl* parameter) {
  if (searched_.insert(definition).second) findReads(definition->getBody(), definition);
  return reads_[{definition, parameter}];
}

void Bundles::note(const clang::FunctionDecl* reader, Place place) {
  std::vector<Path>& paths = reads_[{reader, place.parameter}];
  const auto isBefore = [](const Path& a, const Path& b) {
    return std::ranges::lexicographical_compare(a, b, {}, &clang::FieldDecl::getFieldIndex,
                                                &clang::FieldDecl::getFieldIndex);
  };
  const auto at = std::ranges::lower_bound(paths, place.path, isBefore);
  if (at == paths.end() || *at != place.path) paths.insert(at, std::move(place.path));
}

void Bundles::findReads(const clang::Stmt* statement, const clang::FunctionDecl* reader) {
  if (statement == nullptr) return;
  if (const auto* e = llvm::dyn_cast<clang::Expr>(statement)) {
    if (std::optional<Place> place = placeOf(e)) {
      if (!place->path.empty() && !isBundle(place->path.back()->getType())) note(reader, std::move(*place));
      return;
    }
    const auto* call = llvm::dyn_cast<clang::CallExpr>(e);
    const clang::FunctionDecl* callee = call ? call->getDirectCallee() : nullptr;
    if (const clang::FunctionDecl* definition = callee ? callee->getDefinition() : nullptr) {
      for (const Source& source : parametersOf(definition)) {
        if (source.member.empty()) continue;
        std::optional<Place> place = placeOf(argumentFor(call, callee, source.parameter));
        if (!place) continue;
        place->path.insert(place->path.end(), source.member.begin(), source.member.end());
        note(reader, std::move(*place));
      }
    }
  }
  for (const clang::Stmt* part : statement->children()) findReads(part, reader);
}

}  // namespace skc::frontend
