// SPDX-License-Identifier: MIT
//
// Reports our diagnostics through Clang's engine: the same form, carets, colours, limits and -W switches.
#pragma once

#include <set>

#include <clang/Basic/Diagnostic.h>

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
  clang::DiagnosticsEngine& engine_;
};

}  // namespace skc::frontend
