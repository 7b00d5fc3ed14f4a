// SPDX-License-Identifier: MIT
//
// Bounds the work that a few lines can ask of Clang: macros and includes that double with each level, and templates that
// instantiate each other.
#pragma once

namespace clang {
class Preprocessor;
class Sema;
}  // namespace clang

namespace skc {
class Diagnostics;
}

namespace skc::frontend {

/// More than anybody nests by hand, and than drivers' compilers reliably accept.
inline constexpr int deepestNesting = 1000;

/// Thrown where a bound is reached, after an error has been reported. Clang knows no exceptions: its functions are left without
/// their destructors, so that its objects may only be abandoned.
struct ClangStopped {};

/// Counts expansions of macros, and included files.
void limitPreprocessing(clang::Preprocessor& preprocessor, Diagnostics& diagnostics);

/// Counts instantiations of templates.
void limitTemplates(clang::Sema& sema, Diagnostics& diagnostics);

}  // namespace skc::frontend
