// SPDX-License-Identifier: MIT
//
// Reports our diagnostics through Clang's engine, in the same form, with the same carets, colours, limits and -W switches; and
// prints Clang's own, with our advice.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <tuple>

#include <clang/Basic/Diagnostic.h>
#include <clang/Basic/LangOptions.h>
#include <clang/Frontend/TextDiagnosticPrinter.h>

#include "frontend/advice.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {

class ClangDiagnostics : public Diagnostics {
 public:
  explicit ClangDiagnostics(clang::DiagnosticsEngine& engine) : engine_(engine) {}

  void report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments = {}) override {
    report(diag, loc, arguments, {});
  }
  void report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments,
              const std::vector<FixIt>& fixIts) override;
  /// DiagnosticPrinter turns some warnings into errors, which the engine does not count.
  bool hasErrors() const override {
    return engine_.hasErrorOccurred() || engine_.getClient()->getNumErrors() != 0;
  }

  bool hasReported(Diag diag) const { return reported_.contains(diag); }

 private:
  std::set<Diag> reported_;
  /// With their locations, once each: a function may be lowered to several versions.
  std::set<std::tuple<Diag, std::uint32_t, std::string>> messages_;
  clang::DiagnosticsEngine& engine_;
};

/// The Clang argument that makes narrowing a warning, which this printer turns into an error again.
inline constexpr const char* narrowingArgument = "-Wno-error=c++11-narrowing";

/// Clang's printer with three changes. It drops the narrowing error for a component of a bool vector in a braced
/// list: Clang takes it for a char32_t, but it is a bool and loses nothing. Every other narrowing stays an
/// error, as in C++. Where there is advice of ours, it prints that instead. It drops
/// notes that point into the prelude.
class DiagnosticPrinter : public clang::TextDiagnosticPrinter {
 public:
  DiagnosticPrinter(llvm::raw_ostream& out, clang::DiagnosticOptions* options);
  void BeginSourceFile(const clang::LangOptions& language, const clang::Preprocessor* preprocessor) override;
  void HandleDiagnostic(clang::DiagnosticsEngine::Level level, const clang::Diagnostic& diagnostic) override;
  /// Lets advice depend on the file's declarations, which must live as long as the printer reports.
  void setSyntax(const DeclarationSyntax* syntax) { syntax_ = syntax; }

 private:
  bool isExplained(const clang::Diagnostic& diagnostic) const;
  void print(clang::DiagnosticsEngine::Level level, const clang::Diagnostic& diagnostic,
             const Advice& advice);

  llvm::raw_ostream& out_;
  llvm::IntrusiveRefCntPtr<clang::DiagnosticOptions> options_;
  clang::LangOptions language_;
  const DeclarationSyntax* syntax_ = nullptr;
  clang::SourceLocation explained_;  ///< of the last advice that explains its line
  bool isDropping_ = false;  ///< dropping the notes of a message that was dropped or replaced
};

}  // namespace skc::frontend
