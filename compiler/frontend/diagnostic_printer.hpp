// SPDX-License-Identifier: MIT
//
// Clang's printer with two changes. It drops the narrowing error for a component of a bool vector in a braced
// list: Clang takes it for a char32_t, but it is a bool and loses nothing. Every other narrowing stays an
// error, as in C++. Where Clang's message is about C++ and the mistake is about kernels, such as a name from
// another language or an index of an element, it prints our advice instead, with a fix-it if possible.
#pragma once

#include <string>
#include <vector>

#include <clang/Basic/LangOptions.h>
#include <clang/Frontend/TextDiagnosticPrinter.h>

namespace skc::frontend {

/// The Clang argument that makes narrowing a warning, which this printer turns into an error again.
inline constexpr const char* narrowingArgument = "-Wno-error=c++11-narrowing";

/// Our replacement for one of Clang's messages.
struct Advice {
  std::string text;  ///< "" keeps Clang's own
  std::vector<clang::FixItHint> fixIts = {};
};

class DiagnosticPrinter : public clang::TextDiagnosticPrinter {
 public:
  DiagnosticPrinter(llvm::raw_ostream& out, clang::DiagnosticOptions* options);
  void BeginSourceFile(const clang::LangOptions& language, const clang::Preprocessor* preprocessor) override;
  void HandleDiagnostic(clang::DiagnosticsEngine::Level level, const clang::Diagnostic& diagnostic) override;

 private:
  void print(clang::DiagnosticsEngine::Level level, const clang::Diagnostic& diagnostic,
             const Advice& advice);

  llvm::raw_ostream& out_;
  llvm::IntrusiveRefCntPtr<clang::DiagnosticOptions> options_;
  clang::LangOptions language_;
  bool isDropping_ = false;  ///< dropping the notes of a message that was dropped or replaced
};

}  // namespace skc::frontend
