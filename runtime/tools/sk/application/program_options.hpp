// SPDX-License-Identifier: MIT
//
// What the commands that run an application of the user have in common on their command lines.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace sk_tool {

/// Adds --any-status, and the program with its arguments after --. To be called after all other options, of which those that may be given
/// several times take one value each time.
inline void addProgram(CLI::App& command, std::vector<std::string>& words, bool& anyStatus) {
  command.add_flag("--any-status", anyStatus,
                   "the exit status of the program does not count, because it checks its own results");
  for (CLI::Option* option : command.get_options()) {
    if (!option->get_lnames().empty() && option->get_expected_max() > 1) option->allow_extra_args(false);
  }
  command.add_option("program", words, "after --, the program and its arguments")->required();
}

}  // namespace sk_tool
