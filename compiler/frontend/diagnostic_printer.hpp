// SPDX-License-Identifier: MIT
//
// Clang's printer, with one message less: a component of a bool vector, which Clang takes for a char32_t, is a bool
// and loses nothing where a list in braces makes one of it. Every other narrowing stays the error that it is in C++.
// And where Clang's words are about C++ and the mistake is about kernels, such as a name that people bring from elsewhere or an
// index of an element, it says what to do instead, with a fix-it where one word of ours means the same.
#pragma once

#include <string>
#include <vector>

#include <clang/Basic/LangOptions.h>
#include <clang/Frontend/TextDiagnosticPrinter.h>

namespace skc::frontend {

/// The argument of Clang's that has narrowing reported as a warning, which this printer makes an error again.
inline constexpr const char* narrowingArgument = "-Wno-error=c++11-narrowing";

/// Our words for a message of Clang's.
struct Advice {
  std::string text;  ///< "" where Clang's own will do
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
  bool isDropping_ = false;  ///< the notes of a message that was dropped or replaced
};

}  // namespace skc::frontend
