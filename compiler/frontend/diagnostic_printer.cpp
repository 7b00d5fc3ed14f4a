// SPDX-License-Identifier: MIT
#include "frontend/diagnostic_printer.hpp"

#include <clang/AST/DeclarationName.h>
#include <clang/AST/Type.h>
#include <clang/Basic/DiagnosticSema.h>

#include "frontend/foreign_names.hpp"
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

/// The name that nobody declared; "" in any other message.
std::string unknownName(const clang::Diagnostic& diagnostic) {
  if (diagnostic.getID() != clang::diag::err_undeclared_var_use) return {};
  if (diagnostic.getArgKind(0) == DiagnosticsEngine::ak_identifierinfo)
    return diagnostic.getArgIdentifier(0)->getName().str();
  return clang::DeclarationName::getFromOpaqueInteger(diagnostic.getRawArg(0)).getAsString();
}

}  // namespace

void DiagnosticPrinter::HandleDiagnostic(DiagnosticsEngine::Level level,
                                         const clang::Diagnostic& diagnostic) {
  if (level != DiagnosticsEngine::Note) isDropping_ = isBoolOfVector(diagnostic);
  if (isDropping_) return;
  if (level == DiagnosticsEngine::Warning && isNarrowing(diagnostic)) level = DiagnosticsEngine::Error;
  const std::string name = unknownName(diagnostic);
  if (const std::string_view advice = insteadOf(name); !advice.empty()) {
    const std::string text = format(Diag::ForeignName, {name, advice});
    return TextDiagnosticPrinter::HandleDiagnostic(level, clang::Diagnostic(diagnostic.getDiags(), text));
  }
  TextDiagnosticPrinter::HandleDiagnostic(level, diagnostic);
}

}  // namespace skc::frontend
