// SPDX-License-Identifier: MIT
//
// From a .sk file to the IR. This header is all that the rest of the compiler sees of Clang's side:
// no Clang type crosses it.
#pragma once

#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc::frontend {

struct Options {
  std::vector<std::string> includeDirectories;   ///< -I
  std::vector<std::string> definitions;          ///< -D: NAME or NAME=VALUE
  std::vector<std::string> warnings;             ///< -W, without the -W: "all", "error", "no-unused"
  bool color = false;
  bool fixIts = false;                           ///< in Clang's parseable form
  std::ostream* messages = nullptr;              ///< where messages go; null: standard error
  bool isLibrary = false;                        ///< the file may do without kernels
};

/// One translation unit. It lives until the last diagnostic about it is reported.
class Frontend {
 public:
  explicit Frontend(const Options& options);
  ~Frontend();
  Frontend(const Frontend&) = delete;
  Frontend& operator=(const Frontend&) = delete;

  /// Parses, checks and lowers `path`, which the messages name as given. Empty after errors, which
  /// are where Options has them by then. With a `text`, the file need not exist: it is compiled as if it held
  /// that. Called once.
  std::optional<ir::Module> compile(const std::string& path, std::optional<std::string> text = std::nullopt);

  /// Prints the tree of the file's own declarations, as Clang does. After compile().
  void dumpAst(std::ostream& out) const;

  /// Files that the result depends on: the main file, then what it includes.
  std::vector<std::string> dependencies() const;

  Diagnostics& diagnostics();

 private:
  class Unit;
  std::unique_ptr<Unit> unit_;
};

}  // namespace skc::frontend
