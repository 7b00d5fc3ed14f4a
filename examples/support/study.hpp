// SPDX-License-Identifier: MIT
//
// The studies that `PROGRAM --study NAME` of an example runs. Each prints tables of Markdown, which figures.sh writes into the documentation.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "support/verification.hpp"

namespace examples {

class Application;

struct Findings {
  std::string table;  ///< one or more tables, with an empty line between two of them
  std::vector<Verification> verifications{};
};

struct Study {
  std::string_view name;
  std::string_view asks;  ///< what it finds out, for --help
  Findings (*run)(sk::Device& device, bool small);  ///< small: for tests, coarse and quick
};

/// The options --study and --small of a program, and the study that they select.
class StudyOptions {
 public:
  /// Adds both options. `purpose` precedes the list of studies in --help. The application and the studies must outlive this object.
  StudyOptions(Application& app, std::string_view purpose, std::span<const Study> studies);

  /// Whether the command line names a study.
  bool isGiven() const { return !name_.empty(); }
  /// Runs the named study on the application's device, prints its tables, and passes its verifications to the application.
  /// Throws std::runtime_error if there are several ranks, or, listing the names, if no study has the name.
  void run() const;

 private:
  Application& app_;
  std::span<const Study> studies_;
  std::string name_;
  bool small_ = false;
};

}  // namespace examples
