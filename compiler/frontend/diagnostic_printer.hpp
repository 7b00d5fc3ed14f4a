// SPDX-License-Identifier: MIT
//
// Clang's printer, with one message less: a component of a bool vector, which Clang takes for a char32_t, is a bool
// and loses nothing where a list in braces makes one of it. Every other narrowing stays the error that it is in C++.
// And where Clang's words are about C++ and the mistake is about kernels, such as a name that people bring from elsewhere or an
// index of an element, it says what to do instead.
#pragma once

#include <clang/Frontend/TextDiagnosticPrinter.h>

namespace skc::frontend {

/// The argument of Clang's that has narrowing reported as a warning, which this printer makes an error again.
inline constexpr const char* narrowingArgument = "-Wno-error=c++11-narrowing";

class DiagnosticPrinter : public clang::TextDiagnosticPrinter {
 public:
  using TextDiagnosticPrinter::TextDiagnosticPrinter;
  void HandleDiagnostic(clang::DiagnosticsEngine::Level level, const clang::Diagnostic& diagnostic) override;

 private:
  bool isDropping_ = false;  ///< the notes of a message that was dropped or replaced
};

}  // namespace skc::frontend
