// SPDX-License-Identifier: MIT
#include "frontend/diagnostic_printer.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <optional>
#include <utility>

#include <clang/AST/Decl.h>
#include <clang/AST/DeclCXX.h>
#include <clang/AST/DeclarationName.h>
#include <clang/AST/Type.h>
#include <clang/Basic/DiagnosticLex.h>
#include <clang/Basic/DiagnosticParse.h>
#include <clang/Basic/DiagnosticSema.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Frontend/TextDiagnostic.h>
#include <clang/Lex/Lexer.h>
#include <fmt/format.h>

#include "frontend/foreign_names.hpp"
#include "ir/intrinsics.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {
namespace {

using clang::DiagnosticsEngine;

bool isNarrowing(const clang::Diagnostic& diagnostic) {
  return clang::DiagnosticIDs::getWarningOptionForDiag(diagnostic.getID()) == "c++11-narrowing";
}

bool isBoolOfVector(const clang::Diagnostic& diagnostic) {
  if (diagnostic.getID() != clang::diag::ext_init_list_variable_narrowing) return false;
  const auto type = [&](unsigned argument) {
    void* pointer = reinterpret_cast<void*>(diagnostic.getRawArg(argument));   // how Clang passes types
    return clang::QualType::getFromOpaquePtr(pointer)->getAs<clang::BuiltinType>();
  };
  const clang::BuiltinType *from = type(0), *to = type(1);
  return from != nullptr && to != nullptr && from->getKind() == clang::BuiltinType::Char32 &&
         to->getKind() == clang::BuiltinType::Bool;
}

/// The text of an argument that is a name or a string.
std::string nameIn(const clang::Diagnostic& diagnostic, unsigned argument) {
  switch (diagnostic.getArgKind(argument)) {
    case DiagnosticsEngine::ak_identifierinfo: return diagnostic.getArgIdentifier(argument)->getName().str();
    case DiagnosticsEngine::ak_declarationname:
      return clang::DeclarationName::getFromOpaqueInteger(diagnostic.getRawArg(argument)).getAsString();
    case DiagnosticsEngine::ak_std_string: return diagnostic.getArgStdStr(argument);
    default: return {};
  }
}

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

/// Advice on a name from another language, even if Clang suggests a similar name.
Advice adviceOnForeignName(const clang::Diagnostic& diagnostic) {
  const std::string name = nameIn(diagnostic, 0);
  const std::optional<Instead> instead = insteadOf(name);
  if (!instead) return {};
  return {format(Diag::ForeignName, {name, instead->advice}), replaced(diagnostic, instead->word)};
}

/// Advice on an undeclared name.
Advice adviceOnName(const clang::Diagnostic& diagnostic) {
  if (Advice advice = adviceOnForeignName(diagnostic); !advice.text.empty()) return advice;
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

/// Advice on a directive of GLSL's, such as `#version 330`.
Advice adviceOnDirective(const clang::Diagnostic& diagnostic) {
  clang::SmallString<32> buffer;
  const llvm::StringRef name = clang::Lexer::getSpelling(diagnostic.getLocation(), buffer,
                                                         diagnostic.getSourceManager(), clang::LangOptions());
  const bool isOfGlsl = name == "version" || name == "extension";
  return {isOfGlsl ? format(Diag::ForeignDirective, {name.str()}) : std::string()};
}

Advice adviceOnHeader(const clang::Diagnostic& diagnostic) {
  const std::string file = nameIn(diagnostic, 0);
  return {isLibraryHeader(file) ? format(Diag::LibraryHeader, {file}) : std::string()};
}

/// The source text of one of the ranges that Clang marks, in its order.
llvm::StringRef textOf(const clang::Diagnostic& diagnostic, unsigned range = 0) {
  if (diagnostic.getNumRanges() <= range) return {};
  return clang::Lexer::getSourceText(diagnostic.getRange(range), diagnostic.getSourceManager(),
                                     clang::LangOptions());
}

/// The identifier at the start of a text.
llvm::StringRef nameAt(llvm::StringRef text) {
  return text.take_while([](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; });
}

/// Advice on an index where there is none: `x[0]` of an element x, `a[1][2]` of a gather a of rank 1.
Advice adviceOnIndex(const clang::Diagnostic& diagnostic) {
  const llvm::StringRef base = textOf(diagnostic), name = nameAt(base);
  if (name.empty()) return {};
  const std::size_t taken = base.count('[');
  const bool isIndexed = taken > 0 && base.drop_front(name.size()).ltrim().starts_with("[");
  if (!isIndexed || taken > 4) return {format(Diag::IndexedValue, {base.str(), name.str()})};
  std::string brackets;
  for (std::size_t i = 0; i <= taken; ++i) brackets += "[]";
  return {format(Diag::IndexTooMany, {name.str(), fmt::format("{} ind{}", taken, taken == 1 ? "ex" : "ices"),
                                      fmt::format("{}", taken + 1), brackets})};
}

/// Advice on `x[f]`, where x is an array with a length and f a float.
Advice adviceOnArrayIndex(const clang::Diagnostic& diagnostic) {
  const llvm::StringRef index = textOf(diagnostic);
  if (index.empty()) return {};
  const clang::CharSourceRange range = diagnostic.getRange(0);
  std::vector<clang::FixItHint> fixIts;
  if (!range.getBegin().isMacroID() && !range.getEnd().isMacroID()) {
    fixIts = {clang::FixItHint::CreateReplacement(range, fmt::format("int({})", index.str()))};
  }
  return {format(Diag::ArrayIndexType, {index.str()}), std::move(fixIts)};
}

bool isMask(clang::QualType type) {
  const auto* vector = type.isNull() ? nullptr : llvm::dyn_cast<clang::ExtVectorType>(type.getTypePtr());
  return vector != nullptr && vector->getElementType()->isIntegerType();
}

/// The classes of gather parameters and of variable outputs, in the prelude.
constexpr llvm::StringRef gatherClass = "gather_", variableOutputClass = "variable_output";

bool isOfClass(clang::QualType type, llvm::StringRef name) {
  const clang::CXXRecordDecl* record = type.isNull() ? nullptr : type->getAsCXXRecordDecl();
  return record != nullptr && record->getIdentifier() != nullptr && record->getName().starts_with(name);
}

/// True if an argument of the diagnostic is the type of a gather.
bool namesGather(const clang::Diagnostic& diagnostic) {
  for (unsigned i = 0; i < diagnostic.getNumArgs(); ++i) {
    if (diagnostic.getArgKind(i) != DiagnosticsEngine::ak_qualtype) continue;
    const auto type = clang::QualType::getFromOpaquePtr(reinterpret_cast<void*>(diagnostic.getRawArg(i)));
    if (isOfClass(type, gatherClass)) return true;
  }
  return false;
}

/// The character at a diagnostic's location.
char characterAt(const clang::Diagnostic& diagnostic) {
  bool isInvalid = false;
  const char* text = diagnostic.getSourceManager().getCharacterData(diagnostic.getLocation(), &isInvalid);
  return isInvalid ? '\0' : *text;
}

/// Advice on `x ^ 2` of floats, and on operators between a gather and something else.
Advice adviceOnOperands(const clang::Diagnostic& diagnostic) {
  if (namesGather(diagnostic)) return {format(Diag::GatherAsValue, {})};
  return {characterAt(diagnostic) == '^' ? format(Diag::PowerOperator, {"^"}) : std::string()};
}

/// Advice on `x ** 2`, where the second star dereferences what is not a pointer.
Advice adviceOnIndirection(const clang::Diagnostic& diagnostic) {
  bool isInvalid = false;
  const clang::SourceLocation place = diagnostic.getLocation();
  if (place.isMacroID()) return {};
  const char* text = diagnostic.getSourceManager().getCharacterData(place.getLocWithOffset(-1), &isInvalid);
  return {!isInvalid && *text == '*' ? format(Diag::PowerOperator, {"**"}) : std::string()};
}

/// Advice on `float2 r = a < b`, which mixes a type and the type of a mask.
Advice adviceOnConversion(const clang::Diagnostic& diagnostic) {
  if (namesGather(diagnostic)) return {format(Diag::GatherAsValue, {})};
  clang::QualType mask, wanted;
  for (unsigned i = 0; i < diagnostic.getNumArgs(); ++i) {
    if (diagnostic.getArgKind(i) != DiagnosticsEngine::ak_qualtype) continue;
    const auto type = clang::QualType::getFromOpaquePtr(reinterpret_cast<void*>(diagnostic.getRawArg(i)));
    (isMask(type) ? mask : wanted) = type;
  }
  const auto* vector = wanted.isNull() ? nullptr : wanted->getAs<clang::ExtVectorType>();
  if (mask.isNull() || vector == nullptr) return {};
  if (vector->getElementType()->isChar32Type()) return {};  // bool4(a < b) is a bool vector
  const unsigned ranges = diagnostic.getNumRanges();
  const llvm::StringRef text = ranges == 0 ? llvm::StringRef() : textOf(diagnostic, ranges - 1);
  const bool isShown = !text.empty() && !text.contains('?');
  return {format(Diag::MaskAsNumbers,
                 {wanted.getUnqualifiedType().getAsString(), isShown ? text.str() : "mask"})};
}

Advice adviceOnCall(const clang::Diagnostic& diagnostic) {
  const std::string name = nameIn(diagnostic, 0);
  if (name == "push") return {format(Diag::PushForm, {})};
  if (name == "neighbor") return {format(Diag::GatherArguments, {name, "an offset in each"})};
  if (name == "sample")
    return {format(Diag::GatherArguments, {name, "a position with a component for each"})};
  return {};
}

/// Advice on `a[0] = 1`: only elements of gathers and rows of parameters are indexed and not assignable.
Advice adviceOnAssignment(const clang::Diagnostic& diagnostic) {
  const llvm::StringRef place = textOf(diagnostic), name = nameAt(place);
  const bool isIndexed = !name.empty() && place.drop_front(name.size()).ltrim().starts_with("[");
  return {isIndexed ? format(Diag::GatherAssigned, {place.str(), name.str()}) : std::string()};
}

/// Advice on `a.size()` of an element or a gather, and other members of containers.
Advice adviceOnMember(std::string_view member) {
  constexpr std::string_view ofContainers[] = {"size", "length", "begin", "end", "empty", "data"};
  const bool isKnown = std::ranges::find(ofContainers, member) != std::end(ofContainers);
  return {isKnown ? format(Diag::StreamMember, {member}) : std::string()};
}

/// Advice on a member that a class of the prelude does not have.
Advice adviceOnMissingMember(const clang::Diagnostic& diagnostic) {
  const auto* context = reinterpret_cast<const clang::DeclContext*>(diagnostic.getRawArg(1));
  const auto* type = llvm::dyn_cast_or_null<clang::NamedDecl>(context);
  if (type == nullptr || type->getIdentifier() == nullptr) return {};
  if (type->getName().starts_with(gatherClass)) return adviceOnMember(nameIn(diagnostic, 0));
  return {type->getName() == variableOutputClass ? format(Diag::PushForm, {}) : std::string()};
}

/// Advice on `y = x`, where y is a variable output: the prelude deletes that operator, and gives its class as the reason.
Advice adviceOnDeleted(const clang::Diagnostic& diagnostic) {
  for (unsigned i = 0; i < diagnostic.getNumArgs(); ++i) {
    if (nameIn(diagnostic, i) == variableOutputClass) return {format(Diag::PushForm, {})};
  }
  return {};
}

/// Advice on assigning to an input, a uniform or another parameter that is constant.
Advice adviceOnConstant(const clang::Diagnostic& diagnostic) {
  for (unsigned i = 0; i < diagnostic.getNumArgs(); ++i) {
    if (diagnostic.getArgKind(i) != DiagnosticsEngine::ak_nameddecl) continue;
    const auto* decl = reinterpret_cast<const clang::NamedDecl*>(diagnostic.getRawArg(i));
    if (llvm::isa<clang::ParmVarDecl>(decl)) return {format(Diag::ConstantAssigned, {decl->getName().str()})};
  }
  return {};
}

Advice adviceOn(const clang::Diagnostic& diagnostic) {
  switch (diagnostic.getID()) {
    case clang::diag::err_undeclared_var_use:
    case clang::diag::err_unknown_typename: return adviceOnName(diagnostic);
    case clang::diag::err_undeclared_var_use_suggest:
    case clang::diag::err_unknown_typename_suggest:
    case clang::diag::err_no_template:
    case clang::diag::err_no_template_suggest: return adviceOnForeignName(diagnostic);
    case clang::diag::err_pp_invalid_directive: return adviceOnDirective(diagnostic);
    case clang::diag::err_exceptions_disabled: return {format(Diag::Exceptions, {})};
    case clang::diag::err_main_returns_nonint: return {format(Diag::MainFunction, {})};
    case clang::diag::err_typecheck_invalid_operands: return adviceOnOperands(diagnostic);
    case clang::diag::err_typecheck_indirection_requires_pointer: return adviceOnIndirection(diagnostic);
    case clang::diag::err_pp_file_not_found: return adviceOnHeader(diagnostic);
    case clang::diag::err_typecheck_subscript_value: return adviceOnIndex(diagnostic);
    case clang::diag::err_typecheck_subscript_not_integer: return adviceOnArrayIndex(diagnostic);
    case clang::diag::err_init_conversion_failed:
    case clang::diag::err_typecheck_convert_incompatible: return adviceOnConversion(diagnostic);
    case clang::diag::err_ovl_no_viable_function_in_call: return adviceOnCall(diagnostic);
    case clang::diag::err_typecheck_expression_not_modifiable_lvalue: return adviceOnAssignment(diagnostic);
    case clang::diag::err_typecheck_member_reference_struct_union:
      return adviceOnMember(textOf(diagnostic, 1));
    case clang::diag::err_no_member: return adviceOnMissingMember(diagnostic);
    case clang::diag::err_ovl_deleted_oper: return adviceOnDeleted(diagnostic);
    case clang::diag::err_typecheck_assign_const: return adviceOnConstant(diagnostic);
    case clang::diag::err_ext_vector_component_name_illegal: return adviceOnMember(textOf(diagnostic));
    case clang::diag::err_for_range_invalid: return {format(Diag::RangeFor, {})};
    default: return {};
  }
}

}  // namespace

DiagnosticPrinter::DiagnosticPrinter(llvm::raw_ostream& out, clang::DiagnosticOptions* options)
    : TextDiagnosticPrinter(out, options), out_(out), options_(options) {}

void DiagnosticPrinter::BeginSourceFile(const clang::LangOptions& language,
                                        const clang::Preprocessor* preprocessor) {
  language_ = language;
  TextDiagnosticPrinter::BeginSourceFile(language, preprocessor);
}

void DiagnosticPrinter::HandleDiagnostic(DiagnosticsEngine::Level level,
                                         const clang::Diagnostic& diagnostic) {
  if (level != DiagnosticsEngine::Note) isDropping_ = isBoolOfVector(diagnostic);
  if (isDropping_) return;
  if (level == DiagnosticsEngine::Warning && isNarrowing(diagnostic)) level = DiagnosticsEngine::Error;
  const Advice advice = level == DiagnosticsEngine::Note ? Advice() : adviceOn(diagnostic);
  if (advice.text.empty()) return TextDiagnosticPrinter::HandleDiagnostic(level, diagnostic);
  isDropping_ = true;  // also drops the list of candidates
  print(level, diagnostic, advice);
}

/// Prints as Clang prints its own messages.
void DiagnosticPrinter::print(DiagnosticsEngine::Level level, const clang::Diagnostic& diagnostic,
                              const Advice& advice) {
  DiagnosticConsumer::HandleDiagnostic(level, diagnostic);  // counts errors and warnings
  clang::TextDiagnostic printer(out_, language_, options_.get());
  printer.emitDiagnostic(clang::FullSourceLoc(diagnostic.getLocation(), diagnostic.getSourceManager()), level,
                         advice.text, diagnostic.getRanges(), advice.fixIts);
  out_.flush();
}

}  // namespace skc::frontend
