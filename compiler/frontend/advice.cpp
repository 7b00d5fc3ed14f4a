// SPDX-License-Identifier: MIT
#include "frontend/advice.hpp"

#include <clang/AST/Decl.h>
#include <clang/AST/DeclCXX.h>
#include <clang/Basic/DiagnosticParse.h>
#include <clang/Basic/DiagnosticSema.h>

#include "frontend/diagnostic_parts.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {
namespace {

const clang::NamedDecl* declarationIn(const clang::Diagnostic& diagnostic) {
  for (unsigned i = 0; i < diagnostic.getNumArgs(); ++i) {
    if (diagnostic.getArgKind(i) == clang::DiagnosticsEngine::ak_nameddecl)
      return reinterpret_cast<const clang::NamedDecl*>(diagnostic.getRawArg(i));
  }
  return nullptr;
}

/// Advice on assigning to an input, a uniform or another parameter that is constant.
Advice adviceOnConstant(const clang::Diagnostic& diagnostic) {
  const clang::NamedDecl* assigned = declarationIn(diagnostic);
  const auto* parameter = llvm::dyn_cast_or_null<clang::ParmVarDecl>(assigned);
  if (parameter == nullptr) return {};
  const bool isArray = parameter->getType().getNonReferenceType()->isArrayType();
  return {format(isArray ? Diag::ArrayAssigned : Diag::ConstantAssigned, {assigned->getName().str()})};
}

/// Advice on `return r;` in a kernel.
Advice adviceOnReturn(const clang::Diagnostic& diagnostic, const DeclarationSyntax* syntax) {
  const clang::NamedDecl* function = declarationIn(diagnostic);
  const KernelSyntax* kernel =
      function == nullptr || syntax == nullptr ? nullptr : syntax->kernel(function->getLocation());
  if (kernel == nullptr) return {};
  return {format(Diag::KernelReturns, {wordOf(kernel->kind),
                                       isFold(kernel->kind) ? "the accumulator" : "an output, 'out T r<>'"})};
}

/// Advice on calling a member function that is not const for an object that is.
Advice adviceOnMethod(const clang::Diagnostic& diagnostic) {
  const std::string name = nameIn(diagnostic, 0);
  return {name.empty() ? std::string() : format(Diag::MethodNotConst, {name})};
}

/// Advice on `constexpr float s = sqrt(2.0)`.
Advice adviceOnConstexpr(const clang::Diagnostic& diagnostic) {
  const clang::NamedDecl* variable = declarationIn(diagnostic);
  const std::string called = intrinsicCalledIn(textOf(diagnostic));
  if (variable == nullptr || called.empty()) return {};
  return {format(Diag::ConstexprIntrinsic, {variable->getName().str(), called})};
}

/// Advice on `i >= 0` of an unsigned number.
Advice adviceOnUnsigned(const clang::Diagnostic& diagnostic) {
  return {format(Diag::UnsignedCompared, {nameIn(diagnostic, diagnostic.getNumArgs() - 1)})};
}

}  // namespace

Advice adviceOn(const clang::Diagnostic& diagnostic, const DeclarationSyntax* syntax) {
  switch (diagnostic.getID()) {
    case clang::diag::err_exceptions_disabled: return {format(Diag::Exceptions, {})};
    case clang::diag::err_main_returns_nonint: return {format(Diag::MainFunction, {})};
    case clang::diag::err_implied_comparison_category_type_not_found:
      return {format(Diag::ForeignName, {"<=>", "compare with < and =="})};
    case clang::diag::err_need_header_before_typeid:
      return {format(Diag::ForeignName, {"typeid", "overload a function for each type"})};
    case clang::diag::err_implied_std_initializer_list_not_found:
      return {format(Diag::ForeignName, {"std::initializer_list", "write the type before the braces"})};
    case clang::diag::err_implied_coroutine_type_not_found:
      return {format(Diag::ForeignName, {"coroutines", "write a loop"})};
    case clang::diag::err_for_range_invalid: return {format(Diag::RangeFor, {})};
    case clang::diag::err_typecheck_assign_const: return adviceOnConstant(diagnostic);
    case clang::diag::err_constexpr_var_requires_const_init: return adviceOnConstexpr(diagnostic);
    case clang::diag::err_member_function_call_bad_cvr: return adviceOnMethod(diagnostic);
    case clang::diag::ext_return_has_expr: return adviceOnReturn(diagnostic, syntax);
    case clang::diag::warn_unsigned_always_true_comparison: return adviceOnUnsigned(diagnostic);
    // what C++ leaves undefined, and kernels do not
    case clang::diag::warn_remainder_division_by_zero: return {format(Diag::DivisionByZero, {})};
    case clang::diag::warn_shift_negative:
    case clang::diag::warn_shift_gt_typewidth: return {format(Diag::ShiftCount, {})};
    case clang::diag::warn_impcast_literal_float_to_integer_out_of_range:
    case clang::diag::warn_impcast_float_to_integer_out_of_range:
      return {format(Diag::ConversionOutOfRange, {spellingOf(typesIn(diagnostic).back())})};
    default: break;
  }
  if (Advice advice = adviceOnNames(diagnostic); !advice.text.empty()) return advice;
  return adviceOnValues(diagnostic, syntax);
}

}  // namespace skc::frontend
