// SPDX-License-Identifier: MIT
#include "shadow/report_page.hpp"

#include <catch2/catch.hpp>

namespace {

std::size_t count(const std::string& text, std::string_view part) {
  std::size_t number = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++number;
  return number;
}

}  // namespace

TEST_CASE("a report is put into the page once, as it is") {
  const std::string page = sk::shadow::reportPage(R"({"program": "C:\\new $& \"x\""})");
  CHECK(count(page, R"(const report = {"program": "C:\\new $& \"x\""};)") == 1);
  CHECK(count(page, "/*REPORT*/") == 0);
  CHECK(page.starts_with("<!DOCTYPE html>"));
  CHECK(page.ends_with("</html>\n"));
}

TEST_CASE("texts of a report cannot end its script") {
  const std::string empty = sk::shadow::reportPage("null");
  const std::string page = sk::shadow::reportPage(R"({"program": "</script><!-- <script>"})");
  CHECK(count(page, "</script>") == count(empty, "</script>"));
  CHECK(count(page, R"(\u003c/script>\u003c!-- \u003cscript>)") == 1);
}

TEST_CASE("the page has its styles and scripts, and loads nothing") {
  const std::string page = sk::shadow::reportPage("null");
  CHECK(count(page, "<link") == 0);
  CHECK(count(page, "<script src") == 0);
  CHECK(count(page, "default-src 'none'") == 1);
  for (const char* name :
       {"function make(", "function chartFigure(", "function table(", "function kernelsSection(",
        "function verdicts(", "function showPage(", "#tip {"}) {
    INFO(name);
    CHECK(count(page, name) == 1);
  }
}
