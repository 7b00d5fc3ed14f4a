// SPDX-License-Identifier: MIT
//
// Everything that skc reports about a user's program, as rows of diagnostics.def. A Diagnostics collects or
// prints; the frontend's implementation hands the reports to Clang's engine, so that our messages look like
// Clang's (file, line, column, caret).
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/loc.hpp"

namespace skc {

enum class Severity : std::uint8_t { Error, Warning, Note };

enum class Diag : std::uint16_t {
#define SKC_DIAGNOSTIC(Name, severity, text) Name,
#include "support/diagnostics.def"
#undef SKC_DIAGNOSTIC
};

struct DiagRow {
  std::string_view name;
  Severity severity;
  std::string_view text;     ///< with %0 .. %9 for the arguments
};
const DiagRow& row(Diag diag);

/// A fix-it: an edit of the source that surely corrects the mistake.
struct FixIt {
  enum class Kind : std::uint8_t { Remove, Replace, InsertBefore, InsertAfter };
  Kind kind;
  Loc first;           ///< the token that is edited; Remove and Replace: the first one
  Loc last;            ///< Remove and Replace: the last token
  std::string text;    ///< the inserted or replacing text

  static FixIt remove(Loc first, Loc last) { return {Kind::Remove, first, last, {}}; }
  static FixIt replace(Loc token, std::string text) { return replace(token, token, std::move(text)); }
  static FixIt replace(Loc first, Loc last, std::string text) {
    return {Kind::Replace, first, last, std::move(text)};
  }
  static FixIt insertBefore(Loc token, std::string text) {
    return {Kind::InsertBefore, token, {}, std::move(text)};
  }
  static FixIt insertAfter(Loc token, std::string text) {
    return {Kind::InsertAfter, token, {}, std::move(text)};
  }
};

class Diagnostics {
 public:
  virtual ~Diagnostics() = default;
  virtual void report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments = {}) = 0;
  /// Also takes fix-its, for implementations that can show them.
  virtual void report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments,
                      const std::vector<FixIt>& /*fixIts*/) {
    report(diag, loc, arguments);
  }
  virtual bool hasErrors() const = 0;
};

/// The row's text with the arguments substituted.
std::string format(Diag diag, std::initializer_list<std::string_view> arguments);

/// A Diagnostics that records every report, for tests and for code that wants messages as values.
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
