// SPDX-License-Identifier: MIT
#include "support/diagnostic_log.hpp"

#include <algorithm>

namespace skc {

void DiagnosticLog::report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments) {
  entries_.push_back({diag, loc, format(diag, arguments)});
}

bool DiagnosticLog::hasErrors() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return row(entry.diag).severity == Severity::Error; });
}

}  // namespace skc
