// SPDX-License-Identifier: MIT
//
// One .sk file through all phases, in the order that compile() shows; from a file to files, or in memory, so that
// one process can compile as many programs as it likes.
#pragma once

#include <optional>
#include <string>

#include "driver/options.hpp"
#include "ir/ir.hpp"

namespace skc::driver {

/// Exit status: 0, or 1 after errors, which are on standard error by then.
int compile(const Options& options, const std::string& file);

/// What a compilation in memory has to say.
struct Outcome {
  int status;  ///< as compile() gives it
  std::string output;  ///< what --emit asks for; of stubs the header, then the source
  std::string messages;
};

/// Compiles `text` as if it was in `file`, which need not exist; its includes are real files.
Outcome compileText(const Options& options, const std::string& file, const std::string& text);

/// The same up to the transforms: what the emitters take. No module after errors.
struct Translation {
  std::optional<ir::Module> module;
  std::string messages;
};
Translation translateText(const Options& options, const std::string& file, const std::string& text);

/// What the options ask for of a translated module, without the tree of --emit=ast, which it no longer has.
std::string emitText(const Options& options, const ir::Module& module);

}  // namespace skc::driver
