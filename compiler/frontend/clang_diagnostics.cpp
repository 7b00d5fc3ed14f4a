// SPDX-License-Identifier: MIT
#include "frontend/clang_diagnostics.hpp"

#include <clang/AST/Type.h>
#include <clang/Basic/DiagnosticSema.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Frontend/TextDiagnostic.h>
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
  std::string text = format(diag, arguments);
  if (loc.token != 0 && !messages_.emplace(diag, loc.token, text).second) return;
  // The text is passed as an argument, because `%` has a meaning in Clang's format strings.
  const unsigned id = engine_.getDiagnosticIDs()->getCustomDiagID(level, "%0");
  const clang::DiagnosticBuilder message = engine_.Report(clangLocation(loc), id);
  message << text;
  for (const FixIt& fixIt : fixIts) message << hint(fixIt, engine_.getSourceManager());
}

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

/// True for notes that point into the prelude, which nobody can read.
bool isOfPrelude(DiagnosticsEngine::Level level, const clang::Diagnostic& diagnostic) {
  const clang::SourceLocation location = diagnostic.getLocation();
  return level == DiagnosticsEngine::Note && location.isValid() &&
         diagnostic.getSourceManager().isInSystemHeader(location);
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
  if (level != DiagnosticsEngine::Note) isDropping_ = isBoolOfVector(diagnostic) || isExplained(diagnostic);
  if (isDropping_ || isOfPrelude(level, diagnostic)) return;
  if (level == DiagnosticsEngine::Warning && isNarrowing(diagnostic)) level = DiagnosticsEngine::Error;
  const Advice advice = level == DiagnosticsEngine::Note ? Advice() : adviceOn(diagnostic, syntax_);
  if (advice.text.empty()) return TextDiagnosticPrinter::HandleDiagnostic(level, diagnostic);
  isDropping_ = !advice.keepsNotes;  // also drops the list of candidates
  if (advice.explainsLine) explained_ = diagnostic.getLocation();
  print(level, diagnostic, advice);
}

/// True behind advice that explains its whole line.
bool DiagnosticPrinter::isExplained(const clang::Diagnostic& diagnostic) const {
  if (explained_.isInvalid() || diagnostic.getLocation().isInvalid()) return false;
  const clang::SourceManager& sources = diagnostic.getSourceManager();
  const clang::FullSourceLoc before(explained_, sources), here(diagnostic.getLocation(), sources);
  return before.getFileID() == here.getFileID() && before.getLineNumber() == here.getLineNumber();
}

/// Prints as Clang prints its own messages.
void DiagnosticPrinter::print(DiagnosticsEngine::Level level, const clang::Diagnostic& diagnostic,
                              const Advice& advice) {
  DiagnosticConsumer::HandleDiagnostic(level, diagnostic);  // counts errors and warnings
  clang::TextDiagnostic printer(out_, language_, options_.get());
  const clang::SourceManager& sources = diagnostic.getSourceManager();
  clang::SourceLocation location = diagnostic.getLocation();
  if (advice.isOfMainFile) {
    while (sources.getIncludeLoc(sources.getFileID(location)).isValid())
      location = sources.getIncludeLoc(sources.getFileID(location));
  }
  printer.emitDiagnostic(clang::FullSourceLoc(location, sources), level, advice.text,
                         location == diagnostic.getLocation() ? diagnostic.getRanges()
                                                              : llvm::ArrayRef<clang::CharSourceRange>(),
                         advice.fixIts);
  out_.flush();
}

}  // namespace skc::frontend
