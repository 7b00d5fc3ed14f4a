// SPDX-License-Identifier: MIT
//
// Everything that skc tells its user about a program, as rows of diagnostics.def. A Diagnostics
// collects or prints; the frontend's implementation hands them to Clang's engine, so that messages
// of Clang and ours look the same (file, line, column, caret).
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

/// A change of the file that mends a mistake, for certain and by itself.
struct Mend {
  enum class Kind : std::uint8_t { Remove, Replace, InsertBefore, InsertAfter };
  Kind kind;
  Loc first;           ///< the token that it is about; of Remove, the first one
  Loc last;            ///< of Remove and Replace, the last one
  std::string text;    ///< to insert, or to put in place

  static Mend remove(Loc first, Loc last) { return {Kind::Remove, first, last, {}}; }
  static Mend replace(Loc token, std::string text) { return replace(token, token, std::move(text)); }
  static Mend replace(Loc first, Loc last, std::string text) {
    return {Kind::Replace, first, last, std::move(text)};
  }
  static Mend insertBefore(Loc token, std::string text) {
    return {Kind::InsertBefore, token, {}, std::move(text)};
  }
  static Mend insertAfter(Loc token, std::string text) {
    return {Kind::InsertAfter, token, {}, std::move(text)};
  }
};

class Diagnostics {
 public:
  virtual ~Diagnostics() = default;
  virtual void report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments = {}) = 0;
  /// With what would mend it, for those who can show that.
  virtual void report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments,
                      const std::vector<Mend>& /*mends*/) {
    report(diag, loc, arguments);
  }
  virtual bool hasErrors() const = 0;
};

/// The row's text with its arguments put in.
std::string format(Diag diag, std::initializer_list<std::string_view> arguments);

}  // namespace skc
