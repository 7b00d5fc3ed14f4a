// SPDX-License-Identifier: MIT
//
// Compiles the text of a .sk file for the playground: skc in processes of its own, with limits, which reads no other file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "serve/limited_process.hpp"

namespace sk_tool {

struct Message {
  std::size_t line = 0, column = 0;  ///< from 1; columns count bytes. 0: the message is about the whole file
  std::string severity;  ///< "error", "warning" or "note"
  std::string text;
  bool operator==(const Message&) const = default;
};

/// The messages in what skc wrote to standard error about `file`.
std::vector<Message> messagesOf(std::string_view written, std::string_view file);

/// JSON for the page: `messages`, and, where skc takes the text, `module` (JavaScript), `glsl` and `kernels`, each with its
/// `name` and its `parameters`: `name`, `role`, `type` and `rank`.
std::string compileForPage(const std::string& skc, const std::string& text, const ProcessLimits& limits);

}  // namespace sk_tool
