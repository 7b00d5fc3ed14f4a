// SPDX-License-Identifier: MIT
//
// --verify: the program with other inputs, on which a setting must hold that the search has found. It runs before the search, too, so that
// a command line that cannot serve is refused before hours are spent.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tune/application.hpp"
#include "tune/baseline.hpp"
#include "tune/report.hpp"
#include "tune/truth.hpp"

namespace sk_tool::tune {

/// What counts, as for the program itself.
struct Criteria {
  std::vector<Wanted> wanted;  ///< empty: all reads
  Metric metric = Metric::L2;
  double tolerance = 0;
  bool allowsDecisions = false;
};

class OtherInputs {
 public:
  /// Runs a command line as it is and on the reference. Throws std::runtime_error, which names it, if it does not run, or does not
  /// read what the program reads.
  OtherInputs(const std::string& command, Application application, const Baseline& base, Criteria criteria,
              bool isFresh);

  /// Runs it with a configuration file.
  Verification verify(const std::string& configuration) const;

 private:
  std::string failureOf(Verification& verification, const std::string& configuration) const;

  const std::string command_;
  const Application application_;
  const Criteria criteria_;
  const std::vector<std::string> ignored_;  ///< reads that differ from run to run
  sk::results::Process asItIs_;
  sk::results::Process truth_;
};

}  // namespace sk_tool::tune
