// SPDX-License-Identifier: MIT
//
// The page that shows a shadow report: one file of HTML that loads nothing.
#pragma once

#include <string>
#include <string_view>

namespace sk::shadow {

/// Puts a report, valid JSON as docs/json.md describes it, into the page.
std::string reportPage(std::string_view json);

}  // namespace sk::shadow
