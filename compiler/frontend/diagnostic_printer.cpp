// SPDX-License-Identifier: MIT
#include "frontend/diagnostic_printer.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>

#include <clang/AST/Decl.h>
#include <clang/AST/DeclarationName.h>
#include <clang/AST/Type.h>
#include <clang/Basic/DiagnosticLex.h>
#include <clang/Basic/DiagnosticParse.h>
#include <clang/Basic/DiagnosticSema.h>
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
    void* pointer = reinterpret_cast<void*>(diagnostic.getRawArg(argument));   // as Clang hands types over
    return clang::QualType::getFromOpaquePtr(pointer)->getAs<clang::BuiltinType>();
  };
  const clang::BuiltinType *from = type(0), *to = type(1);
  return from != nullptr && to != nullptr && from->getKind() == clang::BuiltinType::Char32 &&
         to->getKind() == clang::BuiltinType::Bool;
}

/// The text of an argument that is a name.
std::string nameIn(const clang::Diagnostic& diagnostic, unsigned argument) {
  switch (diagnostic.getArgKind(argument)) {
    case DiagnosticsEngine::ak_identifierinfo: return diagnostic.getArgIdentifier(argument)->getName().str();
    case DiagnosticsEngine::ak_declarationname:
      return clang::DeclarationName::getFromOpaqueInteger(diagnostic.getRawArg(argument)).getAsString();
    case DiagnosticsEngine::ak_std_string: return diagnostic.getArgStdStr(argument);
    default: return {};
  }
}

/// The intrinsic that is one letter away from a name. Clang suggests none where there are two, as `sin` and `sinh` for `sinn`.
std::string_view intrinsicLike(llvm::StringRef name) {
  if (name.size() < 4) return {};
  for (const ir::IntrinsicRow& row : ir::intrinsicRows()) {
    if (!row.spelling.empty() && name.edit_distance(row.spelling, true, 1) == 1) return row.spelling;
  }
  return {};
}

/// What stands in for a name that nobody declared.
std::string adviceOnName(const clang::Diagnostic& diagnostic) {
  const std::string name = nameIn(diagnostic, 0);
  if (const std::string_view advice = insteadOf(name); !advice.empty())
    return format(Diag::ForeignName, {name, advice});
  const std::string_view intrinsic = intrinsicLike(name);
  return intrinsic.empty() ? std::string()
                           : format(Diag::ForeignName, {name, fmt::format("did you mean '{}'?", intrinsic)});
}

/// A header of C++'s library, which has no suffix, or of C's.
bool isLibraryHeader(std::string_view file) {
  constexpr std::string_view ofC[] = {"math.h",   "stdio.h",  "stdint.h", "stdlib.h", "string.h",
                                      "stddef.h", "assert.h", "float.h",  "limits.h", "stdbool.h"};
  return file.find_first_of("./") == std::string_view::npos || std::ranges::find(ofC, file) != std::end(ofC);
}

std::string adviceOnHeader(const clang::Diagnostic& diagnostic) {
  const std::string file = nameIn(diagnostic, 0);
  return isLibraryHeader(file) ? format(Diag::LibraryHeader, {file}) : std::string();
}

/// A text that a message is about, in the order in which Clang marks them.
llvm::StringRef textOf(const clang::Diagnostic& diagnostic, unsigned range = 0) {
  if (diagnostic.getNumRanges() <= range) return {};
  return clang::Lexer::getSourceText(diagnostic.getRange(range), diagnostic.getSourceManager(),
                                     clang::LangOptions());
}

/// The name at the beginning of a text.
llvm::StringRef nameAt(llvm::StringRef text) {
  return text.take_while([](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; });
}

/// An index of what has none: `x[0]` where x is an element.
std::string adviceOnIndex(const clang::Diagnostic& diagnostic) {
  const llvm::StringRef base = textOf(diagnostic), name = nameAt(base);
  return name.empty() ? std::string() : format(Diag::IndexedValue, {base.str(), name.str()});
}

std::string adviceOnCall(const clang::Diagnostic& diagnostic) {
  const std::string name = nameIn(diagnostic, 0);
  if (name == "neighbor") return format(Diag::GatherArguments, {name, "an offset in each"});
  if (name == "sample") return format(Diag::GatherArguments, {name, "a position with a component for each"});
  return {};
}

/// `a[0] = 1`: what Clang cannot assign to and has an index is an element of a gather, or a row of a matrix that is a parameter.
std::string adviceOnAssignment(const clang::Diagnostic& diagnostic) {
  const llvm::StringRef place = textOf(diagnostic), name = nameAt(place);
  const bool isIndexed = !name.empty() && place.drop_front(name.size()).ltrim().starts_with("[");
  return isIndexed ? format(Diag::GatherAssigned, {place.str(), name.str()}) : std::string();
}

/// `a.size()`, of an element or a gather: members that containers have.
std::string adviceOnMember(std::string_view member) {
  constexpr std::string_view ofContainers[] = {"size", "length", "begin", "end", "empty", "data"};
  return std::ranges::find(ofContainers, member) != std::end(ofContainers)
             ? format(Diag::StreamMember, {member})
             : std::string();
}

bool isInGather(const clang::Diagnostic& diagnostic) {
  const auto* context = reinterpret_cast<const clang::DeclContext*>(diagnostic.getRawArg(1));
  const auto* type = llvm::dyn_cast_or_null<clang::NamedDecl>(context);
  return type != nullptr && type->getName().starts_with("gather_");
}

/// Our words for a message of Clang's; "" where its own will do.
std::string adviceOn(const clang::Diagnostic& diagnostic) {
  switch (diagnostic.getID()) {
    case clang::diag::err_undeclared_var_use:
    case clang::diag::err_unknown_typename: return adviceOnName(diagnostic);
    case clang::diag::err_pp_file_not_found: return adviceOnHeader(diagnostic);
    case clang::diag::err_typecheck_subscript_value: return adviceOnIndex(diagnostic);
    case clang::diag::err_ovl_no_viable_function_in_call: return adviceOnCall(diagnostic);
    case clang::diag::err_typecheck_expression_not_modifiable_lvalue: return adviceOnAssignment(diagnostic);
    case clang::diag::err_typecheck_member_reference_struct_union:
      return adviceOnMember(textOf(diagnostic, 1));
    case clang::diag::err_no_member:
      return isInGather(diagnostic) ? adviceOnMember(nameIn(diagnostic, 0)) : std::string();
    case clang::diag::err_ext_vector_component_name_illegal: return adviceOnMember(textOf(diagnostic));
    case clang::diag::err_for_range_invalid: return format(Diag::RangeFor, {});
    default: return {};
  }
}

}  // namespace

void DiagnosticPrinter::HandleDiagnostic(DiagnosticsEngine::Level level,
                                         const clang::Diagnostic& diagnostic) {
  if (level != DiagnosticsEngine::Note) isDropping_ = isBoolOfVector(diagnostic);
  if (isDropping_) return;
  if (level == DiagnosticsEngine::Warning && isNarrowing(diagnostic)) level = DiagnosticsEngine::Error;
  const std::string advice = level == DiagnosticsEngine::Note ? "" : adviceOn(diagnostic);
  if (!advice.empty()) {
    isDropping_ = true;  // the candidates that Clang has seen are no help either
    return TextDiagnosticPrinter::HandleDiagnostic(level, clang::Diagnostic(diagnostic.getDiags(), advice));
  }
  TextDiagnosticPrinter::HandleDiagnostic(level, diagnostic);
}

}  // namespace skc::frontend
