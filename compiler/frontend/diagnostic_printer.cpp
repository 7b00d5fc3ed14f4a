// SPDX-License-Identifier: MIT
#include "frontend/diagnostic_printer.hpp"

#include <clang/AST/Type.h>
#include <clang/Basic/DiagnosticSema.h>

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

}  // namespace

void DiagnosticPrinter::HandleDiagnostic(DiagnosticsEngine::Level level,
                                         const clang::Diagnostic& diagnostic) {
  if (level != DiagnosticsEngine::Note) isDropping_ = isBoolOfVector(diagnostic);
  if (isDropping_) return;
  if (level == DiagnosticsEngine::Warning && isNarrowing(diagnostic)) level = DiagnosticsEngine::Error;
  TextDiagnosticPrinter::HandleDiagnostic(level, diagnostic);
}

}  // namespace skc::frontend
