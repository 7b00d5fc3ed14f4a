// SPDX-License-Identifier: MIT
#include "shadow/report_page.hpp"

#include "shadow_text/page.hpp"

namespace sk::shadow {

std::string reportPage(std::string_view json) {
  constexpr std::string_view marker = "/*REPORT*/null";
  std::string page;
  for (const std::string_view part : pageParts) page += part;
  std::string inScript;
  inScript.reserve(json.size());
  for (const char c : json) {  // "</script>" and "<!--" mean something even within a text of JavaScript
    if (c == '<') {
      inScript += "\\u003c";
    } else {
      inScript += c;
    }
  }
  page.replace(page.find(marker), marker.size(), inScript);
  return page;
}

}  // namespace sk::shadow
