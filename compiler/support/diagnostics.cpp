// SPDX-License-Identifier: MIT
#include "support/diagnostics.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace skc {
namespace {

using enum Severity;

constexpr DiagRow rows[] = {
#define SKC_DIAGNOSTIC(Name, severity, text) {#Name, severity, text},
#include "support/diagnostics.def"
#undef SKC_DIAGNOSTIC
};

}  // namespace

const DiagRow& row(Diag diag) { return rows[static_cast<std::size_t>(diag)]; }

std::string format(Diag diag, std::initializer_list<std::string_view> arguments) {
  const std::string_view text = row(diag).text;
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool isArgument = text[i] == '%' && i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9';
    if (!isArgument) {
      result += text[i];
      continue;
    }
    const auto number = static_cast<std::size_t>(text[++i] - '0');
    assert(number < arguments.size() && "a row of diagnostics.def wants an argument that was not given");
    result += arguments.begin()[number];
  }
  return result;
}

void DiagnosticLog::report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments) {
  entries_.push_back({diag, loc, format(diag, arguments)});
}

bool DiagnosticLog::hasErrors() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return row(entry.diag).severity == Severity::Error; });
}

}  // namespace skc
