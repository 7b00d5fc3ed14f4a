// SPDX-License-Identifier: MIT
//
// Compiles one .sk file: compile() shows all phases in order. Works from file to files, or in memory, so that
// one process can compile any number of programs.
#pragma once

#include <optional>
#include <string>

#include "driver/options.hpp"
#include "ir/ir.hpp"

namespace skc::driver {

/// Returns the exit status: 0, or 1 after errors, which have been written to standard error.
int compile(const Options& options, const std::string& file);

/// The result of a compilation in memory.
struct Outcome {
  int status;  ///< exit status, as compile() returns it
  std::string output;  ///< what --emit asks for; for stubs the header, then the source
  std::string messages;
};

/// Compiles `text` as if it were the contents of `file`, which need not exist; its includes are real files.
Outcome compileText(const Options& options, const std::string& file, const std::string& text);

/// The result of all phases before the emitters. Has no module after errors.
struct Translation {
  std::optional<ir::Module> module;
  std::string messages;
};
Translation translateText(const Options& options, const std::string& file, const std::string& text);

/// The output that the options ask for, from a translated module; nothing for --emit=ast, whose tree is gone.
std::string emitText(const Options& options, const ir::Module& module);

}  // namespace skc::driver
