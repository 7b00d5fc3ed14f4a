// SPDX-License-Identifier: MIT
#include "frontend/advice.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <clang/AST/Decl.h>
#include <clang/AST/DeclCXX.h>
#include <clang/Basic/DiagnosticLex.h>
#include <clang/Basic/DiagnosticParse.h>
#include <clang/Basic/DiagnosticSema.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Lex/Lexer.h>
#include <fmt/format.h>

#include "frontend/diagnostic_parts.hpp"
#include "ir/intrinsics.hpp"
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

/// Advice on kernels that differ in brackets alone: C++'s overloads do not see those of elements and accumulators.
Advice adviceOnRedefinition(const clang::Diagnostic& diagnostic, const DeclarationSyntax* syntax) {
  const KernelSyntax* kernel = syntax == nullptr ? nullptr : syntax->kernel(diagnostic.getLocation());
  if (kernel == nullptr) return {};
  constexpr std::string_view wayOut = "give one of them another name";
  return {
      .text = format(
          Diag::KernelRedefined,
          {wordOf(kernel->kind), std::string_view(nameAt(textAt(diagnostic))),
           isFold(kernel->kind)
               ? fmt::format("{}, or let the overload that folds accumulators take the uniform, too", wayOut)
               : std::string(wayOut)}),
      .keepsNotes = true};
}

/// Advice on `gather<float, 5>` and `index<5>`.
Advice adviceOnRank(const clang::Diagnostic& diagnostic) {
  const clang::NamedDecl* named = declarationIn(diagnostic);
  const std::string alias = named == nullptr ? "" : named->getNameAsString();
  if (alias != "gather" && alias != "index") return {};
  return {format(Diag::TemplateRank, {alias}), {}, true};
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
    case clang::diag::err_redefinition: return adviceOnRedefinition(diagnostic, syntax);
    case clang::diag::err_template_arg_list_constraints_not_satisfied: return adviceOnRank(diagnostic);
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

namespace {

// ---- names from other languages that kernels do not have (foreign_names.def) -------------------

/// What to use instead of such a name.
struct Instead {
  std::string advice;             ///< what to do
  std::string_view word = {};     ///< a word of ours that means the same; "" if there is none
};

/// The advice for `name` in foreign_names.def; nullopt if it is not there.
std::optional<Instead> insteadOf(std::string_view name) {
#define SKC_FOREIGN_NAME(known, advice) \
  if (name == known) return Instead{advice};
#define SKC_FOREIGN_WORD(known, ours) \
  if (name == known) return Instead{fmt::format("use {}", ours), ours};
#include "frontend/foreign_names.def"
  return std::nullopt;
}

// ---- advice ------------------------------------------------------------------------------------

/// An intrinsic whose name differs in one letter. Clang suggests none if two are equally close.
std::string_view intrinsicLike(llvm::StringRef name) {
  if (name.size() < 4) return {};
  for (const ir::IntrinsicRow& row : ir::intrinsicRows()) {
    if (!row.spelling.empty() && name.edit_distance(row.spelling, true, 1) == 1) return row.spelling;
  }
  return {};
}

/// A fix-it that replaces the word at the diagnostic's location.
std::vector<clang::FixItHint> replaced(const clang::Diagnostic& diagnostic, std::string_view word) {
  if (word.empty() || diagnostic.getLocation().isMacroID()) return {};
  return {clang::FixItHint::CreateReplacement(clang::SourceRange(diagnostic.getLocation()), word)};
}

/// Advice on `std::vector` and its like: about the name behind `std::`, if we know it.
Advice adviceOnMemberOf(const clang::Diagnostic& diagnostic, const std::string& scope) {
  llvm::StringRef rest = textAt(diagnostic).drop_front(std::min(scope.size(), textAt(diagnostic).size()));
  rest = rest.ltrim();
  if (!rest.consume_front("::") && !rest.consume_front(".")) return {};
  const llvm::StringRef member = nameAt(rest.ltrim());
  const std::string name = scope + "::" + member.str();
  std::optional<Instead> instead = insteadOf(name);
  if (!instead) instead = insteadOf(std::string_view(member));
  if (!instead) return {};
  return {format(Diag::ForeignName, {name, instead->advice}), {}, true};
}

/// Advice on a name from another language, even if Clang suggests a similar name.
Advice adviceOnForeignName(const clang::Diagnostic& diagnostic) {
  const std::string name = nameIn(diagnostic, 0);
  const std::optional<Instead> instead = insteadOf(name);
  if (!instead) return {};
  if (Advice advice = adviceOnMemberOf(diagnostic, name); !advice.text.empty()) return advice;
  const bool isScope = name == "std" || name == "Math" || name == "math" || name == "np" || name == "jnp";
  return {format(Diag::ForeignName, {name, instead->advice}), replaced(diagnostic, instead->word), isScope};
}

/// True if the text behind the diagnostic defines a function of this name: `int fact(int n) {`.
bool isDefinedBelow(const clang::Diagnostic& diagnostic, llvm::StringRef name) {
  constexpr std::size_t longestList = 1000;
  const llvm::StringRef text = textAt(diagnostic);
  for (std::size_t at = text.find(name, 1); at != llvm::StringRef::npos; at = text.find(name, at + 1)) {
    const llvm::StringRef before = text.take_front(at), rest = text.drop_front(at + name.size()).ltrim();
    const llvm::StringRef parameters = bracketedAt(rest.take_front(longestList));
    const bool isTyped = before.ends_with(" ") && nameAt(before.rtrim().take_back(1)).size() == 1;
    const bool hasBody = rest.drop_front(parameters.size()).ltrim().starts_with("{");
    if (isTyped && rest.starts_with("(") && !parameters.empty() && hasBody) return true;
  }
  return false;
}

Advice adviceOnLaterFunction(const clang::Diagnostic& diagnostic) {
  const std::string name = nameIn(diagnostic, 0);
  if (name.empty() || !isDefinedBelow(diagnostic, name)) return {};
  return {format(Diag::DefinedBelow, {name})};
}

/// Advice on an undeclared name.
Advice adviceOnName(const clang::Diagnostic& diagnostic) {
  if (nameIn(diagnostic, 0) == "vout") return {format(Diag::VariableOutputBrackets, {"r"}), {}, true};
  if (Advice advice = adviceOnForeignName(diagnostic); !advice.text.empty()) return advice;
  if (Advice advice = adviceOnLaterFunction(diagnostic); !advice.text.empty()) return advice;
  const std::string name = nameIn(diagnostic, 0);
  const std::string_view intrinsic = intrinsicLike(name);
  if (intrinsic.empty()) return {};
  return {format(Diag::ForeignName, {name, fmt::format("did you mean '{}'?", intrinsic)}),
          replaced(diagnostic, intrinsic)};
}

/// True for a header of the C++ library, which has no suffix, or of the C library.
bool isLibraryHeader(std::string_view file) {
  constexpr std::string_view ofC[] = {"math.h",   "stdio.h",  "stdint.h", "stdlib.h", "string.h",
                                      "stddef.h", "assert.h", "float.h",  "limits.h", "stdbool.h"};
  return file.find_first_of("./") == std::string_view::npos || std::ranges::find(ofC, file) != std::end(ofC);
}

Advice adviceOnHeader(const clang::Diagnostic& diagnostic) {
  const std::string file = nameIn(diagnostic, 0);
  return {isLibraryHeader(file) ? format(Diag::LibraryHeader, {file}) : std::string()};
}

/// Advice on a directive of GLSL's, such as `#version 330`.
Advice adviceOnDirective(const clang::Diagnostic& diagnostic) {
  clang::SmallString<32> buffer;
  const llvm::StringRef name = clang::Lexer::getSpelling(diagnostic.getLocation(), buffer,
                                                         diagnostic.getSourceManager(), clang::LangOptions());
  const bool isOfGlsl = name == "version" || name == "extension";
  return {isOfGlsl ? format(Diag::ForeignDirective, {name.str()}) : std::string()};
}

}  // namespace

Advice adviceOnNames(const clang::Diagnostic& diagnostic) {
  switch (diagnostic.getID()) {
    case clang::diag::err_undeclared_var_use:
    case clang::diag::err_unknown_typename: return adviceOnName(diagnostic);
    case clang::diag::err_undeclared_var_use_suggest:
      if (Advice advice = adviceOnForeignName(diagnostic); !advice.text.empty()) return advice;
      return adviceOnLaterFunction(diagnostic);
    case clang::diag::err_unknown_typename_suggest:
    case clang::diag::err_no_template:
    case clang::diag::err_no_template_suggest: return adviceOnForeignName(diagnostic);
    case clang::diag::err_pp_include_too_deep: return {format(Diag::IncludeTooDeep, {}), {}, false, true};
    case clang::diag::err_pp_file_not_found: return adviceOnHeader(diagnostic);
    case clang::diag::err_pp_invalid_directive: return adviceOnDirective(diagnostic);
    default: return {};
  }
}

}  // namespace skc::frontend
