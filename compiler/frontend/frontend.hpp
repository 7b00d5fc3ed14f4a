// SPDX-License-Identifier: MIT
//
// Compiles a .sk file to the IR. The rest of the compiler sees only this header of the code that uses Clang,
// so it has no Clang types.
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
  bool fixIts = false;                           ///< print them in Clang's parseable form
  std::ostream* messages = nullptr;              ///< where messages go; null: standard error
  bool isLibrary = false;                        ///< the file need not have kernels
  bool isIsolated = false;  ///< no other file is read: #include and #embed find nothing
};

/// One translation unit. It must outlive every report of a diagnostic about it.
class Frontend {
 public:
  explicit Frontend(const Options& options);
  ~Frontend();
  Frontend(const Frontend&) = delete;
  Frontend& operator=(const Frontend&) = delete;

  /// Parses, checks and lowers `path`; messages name it as given. Returns nullopt after errors, which have
  /// been written where Options says. If `text` is given, it is compiled as the contents of the file, which
  /// need not exist. Call it once.
  std::optional<ir::Module> compile(const std::string& path, std::optional<std::string> text = std::nullopt);

  /// Prints Clang's tree of the file's own declarations. Call after compile().
  void dumpAst(std::ostream& out) const;

  /// The files that the result depends on: the main file, then its includes.
  std::vector<std::string> dependencies() const;

  Diagnostics& diagnostics();

 private:
  class Unit;
  std::unique_ptr<Unit> unit_;
};

}  // namespace skc::frontend
