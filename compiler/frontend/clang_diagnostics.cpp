// SPDX-License-Identifier: MIT
#include "frontend/clang_diagnostics.hpp"

#include <clang/Basic/SourceManager.h>
#include <clang/Lex/Lexer.h>

#include "frontend/clang_loc.hpp"

namespace skc::frontend {

namespace {

clang::DiagnosticIDs::Level levelOf(Severity severity, const clang::DiagnosticsEngine& engine) {
  switch (severity) {
    case Severity::Error: return clang::DiagnosticIDs::Error;
    case Severity::Note: return clang::DiagnosticIDs::Note;
    case Severity::Warning: break;
  }
  // Clang applies -w and -Werror only to its own diagnostics
  if (engine.getIgnoreAllWarnings()) return clang::DiagnosticIDs::Ignored;
  return engine.getWarningsAsErrors() ? clang::DiagnosticIDs::Error : clang::DiagnosticIDs::Warning;
}

clang::FixItHint hint(const FixIt& fixIt, const clang::SourceManager& sources) {
  const clang::SourceLocation first = clangLocation(fixIt.first);
  switch (fixIt.kind) {
    case FixIt::Kind::Remove: return clang::FixItHint::CreateRemoval({first, clangLocation(fixIt.last)});
    case FixIt::Kind::Replace:
      return clang::FixItHint::CreateReplacement(clang::SourceRange(first, clangLocation(fixIt.last)),
                                                 fixIt.text);
    case FixIt::Kind::InsertBefore: return clang::FixItHint::CreateInsertion(first, fixIt.text);
    case FixIt::Kind::InsertAfter: break;
  }
  const clang::SourceLocation end =
      clang::Lexer::getLocForEndOfToken(first, 0, sources, clang::LangOptions());
  return clang::FixItHint::CreateInsertion(end, fixIt.text);
}

}  // namespace

void ClangDiagnostics::report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments,
                              const std::vector<FixIt>& fixIts) {
  const DiagRow& entry = row(diag);
  const clang::DiagnosticIDs::Level level = levelOf(entry.severity, engine_);
  if (level == clang::DiagnosticIDs::Ignored) return;
  reported_.insert(diag);
  // The text is passed as an argument, because `%` has a meaning in Clang's format strings.
  const unsigned id = engine_.getDiagnosticIDs()->getCustomDiagID(level, "%0");
  const clang::DiagnosticBuilder message = engine_.Report(clangLocation(loc), id);
  message << format(diag, arguments);
  for (const FixIt& fixIt : fixIts) message << hint(fixIt, engine_.getSourceManager());
}

}  // namespace skc::frontend
