// SPDX-License-Identifier: MIT
//
// A Diagnostics that records every report, for tests and for code that wants messages as values.
#pragma once

#include <string>
#include <vector>

#include "support/diagnostics.hpp"

namespace skc {

class DiagnosticLog : public Diagnostics {
 public:
  struct Entry {
    Diag diag;
    Loc loc;
    std::string text;
  };

  using Diagnostics::report;
  void report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments = {}) override;
  bool hasErrors() const override;
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
};

}  // namespace skc
