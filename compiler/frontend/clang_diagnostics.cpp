// SPDX-License-Identifier: MIT
#include "frontend/clang_diagnostics.hpp"

#include "frontend/clang_loc.hpp"

namespace skc::frontend {

namespace {

clang::DiagnosticIDs::Level levelOf(Severity severity, const clang::DiagnosticsEngine& engine) {
  switch (severity) {
    case Severity::Error: return clang::DiagnosticIDs::Error;
    case Severity::Note: return clang::DiagnosticIDs::Note;
    case Severity::Warning: break;
  }
  // Clang maps only its own rows through -w and -Werror
  if (engine.getIgnoreAllWarnings()) return clang::DiagnosticIDs::Ignored;
  return engine.getWarningsAsErrors() ? clang::DiagnosticIDs::Error : clang::DiagnosticIDs::Warning;
}

}  // namespace

void ClangDiagnostics::report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments) {
  const DiagRow& entry = row(diag);
  const clang::DiagnosticIDs::Level level = levelOf(entry.severity, engine_);
  if (level == clang::DiagnosticIDs::Ignored) return;
  // The text is put together here and handed over as an argument: a user's `%` is no placeholder then.
  const unsigned id = engine_.getDiagnosticIDs()->getCustomDiagID(level, "%0");
  engine_.Report(clangLocation(loc), id) << format(diag, arguments);
}

}  // namespace skc::frontend
