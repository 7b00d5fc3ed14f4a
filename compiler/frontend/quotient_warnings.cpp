// SPDX-License-Identifier: MIT
#include "frontend/quotient_warnings.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <clang/AST/Decl.h>
#include <clang/AST/DeclCXX.h>
#include <clang/AST/DeclTemplate.h>
#include <clang/AST/ExprCXX.h>
#include <clang/AST/Stmt.h>
#include <clang/Basic/SourceManager.h>
#include <fmt/format.h>

#include "frontend/clang_loc.hpp"

namespace skc::frontend {
namespace {

/// An integer literal, perhaps with a sign; nullopt for other expressions and for what macros wrote.
std::optional<std::int64_t> writtenInteger(const clang::Expr* e) {
  e = e->IgnoreParenImpCasts();
  if (const auto* sign = llvm::dyn_cast<clang::UnaryOperator>(e);
      sign != nullptr && sign->getOpcode() == clang::UO_Minus) {
    const auto number = writtenInteger(sign->getSubExpr());
    return number ? std::optional(-*number) : std::nullopt;
  }
  const auto* literal = llvm::dyn_cast<clang::IntegerLiteral>(e);
  if (literal == nullptr || literal->getLocation().isMacroID()) return std::nullopt;
  if (!literal->getValue().isIntN(32)) return std::nullopt;
  return static_cast<std::int64_t>(literal->getValue().getZExtValue());
}

class QuotientChecker {
 public:
  QuotientChecker(clang::ASTContext& context, Diagnostics& diagnostics)
      : context_(context), diagnostics_(diagnostics) {}

  void declarations(const clang::DeclContext* scope) {
    for (const clang::Decl* declaration : scope->decls()) {
      if (declaration->isImplicit() || isPrelude(declaration)) continue;
      if (const auto* pattern = llvm::dyn_cast<clang::FunctionTemplateDecl>(declaration)) {
        for (const clang::FunctionDecl* instance : pattern->specializations()) function(instance);
      } else if (const auto* classes = llvm::dyn_cast<clang::ClassTemplateDecl>(declaration)) {
        for (const clang::ClassTemplateSpecializationDecl* instance : classes->specializations())
          declarations(instance);
      } else if (const auto* one = llvm::dyn_cast<clang::FunctionDecl>(declaration)) {
        function(one);
      } else if (const auto* variable = llvm::dyn_cast<clang::VarDecl>(declaration)) {
        if (variable->getInit() != nullptr) statement(variable->getInit());
      } else if (const auto* inner = llvm::dyn_cast<clang::DeclContext>(declaration)) {
        declarations(inner);
      }
    }
  }

 private:
  bool isPrelude(const clang::Decl* declaration) const {
    return context_.getSourceManager().isInSystemHeader(declaration->getLocation());
  }

  void function(const clang::FunctionDecl* declaration) {
    if (declaration->isThisDeclarationADefinition() && !declaration->isDependentContext())
      statement(declaration->getBody());
  }

  /// Visits without recursion, because expressions may nest deeply.
  void statement(const clang::Stmt* root) {
    std::vector<const clang::Stmt*> open = {root};
    while (!open.empty()) {
      const clang::Stmt* one = open.back();
      open.pop_back();
      if (one == nullptr) continue;
      if (const auto* cast = llvm::dyn_cast<clang::CastExpr>(one);
          cast != nullptr && cast->getCastKind() == clang::CK_IntegralToFloating) {
        value(cast->getSubExpr());
      }
      if (const auto* call = llvm::dyn_cast<clang::CallExpr>(one)) arguments(*call);
      for (const clang::Stmt* child : one->children()) open.push_back(child);
    }
  }

  /// Intrinsics and vectors take arguments of any type and convert them: pow(x, 1/3), float2(1/2, 0).
  void arguments(const clang::CallExpr& call) {
    const clang::FunctionDecl* callee = call.getDirectCallee();
    if (callee == nullptr || !isPrelude(callee) || llvm::isa<clang::CXXOperatorCallExpr>(call)) return;
    if (!call.getType().getCanonicalType()->hasFloatingRepresentation()) return;
    for (const clang::Expr* argument : call.arguments()) value(argument);
  }

  /// Reports `1/2` where the value is a float, also as a term or factor of one: `1/2 * n`.
  void value(const clang::Expr* whole) {
    std::vector<const clang::Expr*> open = {whole};
    while (!open.empty()) {
      const auto* operation = llvm::dyn_cast<clang::BinaryOperator>(open.back()->IgnoreParenImpCasts());
      open.pop_back();
      if (operation == nullptr) continue;
      if (operation->getOpcode() == clang::BO_Div) quotient(*operation);
      if (operation->getOpcode() != clang::BO_Mul && !operation->isAdditiveOp()) continue;
      open.push_back(operation->getRHS());
      open.push_back(operation->getLHS());
    }
  }

  void quotient(const clang::BinaryOperator& division) {
    const std::optional<std::int64_t> dividend = writtenInteger(division.getLHS());
    const std::optional<std::int64_t> divisor = writtenInteger(division.getRHS());
    if (!dividend || !divisor || *divisor == 0 || *dividend % *divisor == 0) return;
    if (!reported_.insert(division.getOperatorLoc().getRawEncoding()).second) return;
    diagnostics_.report(Diag::LiteralQuotient, locOf(division.getOperatorLoc()),
                        {fmt::format("{}/{}", *dividend, *divisor), std::to_string(*dividend / *divisor),
                         fmt::format("{}.0/{}", *dividend, *divisor)});
  }

  clang::ASTContext& context_;
  Diagnostics& diagnostics_;
  std::set<unsigned> reported_;   ///< instances of a template share locations
};

}  // namespace

void warnOfQuotients(clang::ASTContext& context, Diagnostics& diagnostics) {
  QuotientChecker(context, diagnostics).declarations(context.getTranslationUnitDecl());
}

}  // namespace skc::frontend
