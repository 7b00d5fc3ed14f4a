// SPDX-License-Identifier: MIT
//
// Trials: runs of the program with a setting, each judged once and timed any number of times. They are kept in a state file, from
// which a search goes on where it was ended: the search itself is deterministic, and asks for the same trials again.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "accuracy/progress.hpp"
#include "tune/application.hpp"
#include "tune/judge.hpp"
#include "tune/setting.hpp"

namespace sk_tool::tune {

struct Trial {
  Setting setting = {};
  std::string failure = {};  ///< why the program did not run; empty if it did
  Verdict verdict = {};
  std::vector<double> seconds = {};  ///< of each run
  std::map<std::string, double> kernels = {};  ///< the fewest seconds of each kernel, where they are known
  std::map<std::string, double> lastKernels = {};  ///< likewise those of the last run

  double median() const;
  double least() const;
};

/// How two settings compare that have run in turns.
struct Comparison {
  double first = 0, second = 0;  ///< the medians of their seconds, in these rounds alone
  int wins = 0;  ///< rounds in which it was faster
  int rounds = 0;

  /// Whether the second is faster by this part of the first, and not by chance: in four of five rounds.
  bool isFaster(double least) const { return ratio() < 1 - least && 5 * wins >= 4 * rounds; }
  double ratio() const { return first > 0 ? second / first : 1; }
  double saved() const { return first - second; }
};

/// Thrown where another run would go beyond the budget.
struct OutOfBudget {};

class Trials {
 public:
  struct Options {
    std::chrono::duration<double> budget{300};
    std::chrono::duration<double> limit{3600};  ///< of one run
    bool allowsDecisions = false;
    bool measures = false;  ///< wait around each kernel, because the devices queue calls
    std::string stateFile = {};  ///< empty: nothing is kept
    std::string key = {};  ///< what all trials depend on
  };

  Trials(const Application& application, const BaseFile& base, ProgramFacts facts, const Judge& judge,
         Options options);

  /// Reads the trials of an earlier search from the state file. Throws std::runtime_error if it is missing, damaged, or of another
  /// program, arguments or results.
  void load();

  /// The trial of a setting, which runs if it has not run before. Throws OutOfBudget.
  const Trial& run(const Setting& setting);
  /// Whether a trial ran, is exact enough, and keeps all decisions, unless these may change.
  bool holds(const Trial& trial) const;
  /// Likewise, whatever its errors are.
  bool isAllowed(const Trial& trial) const;
  /// Runs two settings in turns, both of which must have run. Compares the seconds of one kernel if one is named and its times are
  /// known, which other work on the machine changes less. Throws OutOfBudget.
  Comparison compare(const Setting& first, const Setting& second, int rounds, const std::string& kernel = {});
  /// Runs a setting until it has been timed this often. Throws OutOfBudget.
  void time(const Setting& setting, std::size_t count);

  /// Runs are no longer refused: what the search has found is compared with the program as it is, even if the budget has ended the search.
  void liftBudget() { hasBudget_ = false; }

  /// All trials, in the order in which they ran first.
  std::vector<const Trial*> all() const;
  int runs() const { return runs_; }
  /// Whether the program waits around each kernel, because its devices queue calls.
  bool measures() const { return options_.measures; }
  /// The configuration file of a setting.
  std::string fileOf(const Setting& setting, const FileTexts& texts = {}) const {
    return base_.text(setting, facts_, texts);
  }

 private:
  void runOnce(Trial& trial);
  void save() const;

  const Application& application_;
  const BaseFile& base_;
  const ProgramFacts facts_;
  const Judge& judge_;
  const Options options_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  Progress progress_{"sk tune"};
  std::map<Setting, Trial> trials_;
  std::vector<Setting> order_;
  int runs_ = 0;
  bool hasBudget_ = true;
  double longest_ = 0;  ///< seconds of a run
};

double medianOf(std::vector<double> numbers);

}  // namespace sk_tool::tune
