// SPDX-License-Identifier: MIT
//
// Promises: the rows' texts follow their style, and arguments land where the row says.
#include "support/diagnostics.hpp"

#include <cctype>
#include <string>

#include <catch2/catch.hpp>


namespace skc {
namespace {

constexpr Diag all[] = {
#define SKC_DIAGNOSTIC(Name, severity, text) Diag::Name,
#include "support/diagnostics.def"
#undef SKC_DIAGNOSTIC
};

TEST_CASE("arguments are put where the row says") {
  CHECK(format(Diag::ReduceNeedsIdentity, {"sum", "float", "Stats", "total", "reduce"}) ==
        "'sum' folds float into 'Stats', so it needs a value to start from; "
        "write 'reduce Stats total<> = ...'");
}

TEST_CASE("an argument's own percent sign stays as it is") {
  CHECK(format(Diag::ReduceNeedsIdentity, {"%1", "b", "c", "d", "reduce"}).rfind("'%1' folds b", 0) == 0);
}

TEST_CASE("every message starts in lower case or with a quote and ends without a period") {
  for (Diag diag : all) {
    const DiagRow& entry = row(diag);
    INFO(entry.name);
    REQUIRE_FALSE(entry.text.empty());
    CHECK_FALSE(std::isupper(static_cast<unsigned char>(entry.text.front())));
    CHECK(entry.text.back() != '.');
  }
}

TEST_CASE("a log keeps its messages and knows errors") {
  DiagnosticLog log;
  CHECK_FALSE(log.hasErrors());
  log.report(Diag::ReduceNeedsIdentity, Loc{.token = 1, .line = 7, .file = 0},
             {"a", "b", "c", "d", "reduce"});
  REQUIRE(log.entries().size() == 1);
  CHECK(log.entries()[0].loc.line == 7);
  CHECK(log.hasErrors());
}

}  // namespace
}  // namespace skc
