// SPDX-License-Identifier: MIT
//
// A run of the benchmarks: for each program and size, everybody who can solves the problem, is checked, and those who
// are right are raced.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ours.hpp"
#include "peers.hpp"
#include "programs.hpp"
#include "rounds.hpp"

namespace race {

struct Settings {
  std::string filter = ".*";  ///< a regular expression that is found in the names of the programs to run
  std::vector<int> sizes = {};  ///< logarithms to base 2; none: each program's own
  std::string only =
      ".*";  ///< a regular expression that is found in the names of the contenders that take part
  bool withPeers = true;
  int busyProcesses = 0;  ///< if there are any, all problems are solved beside them once more
  double longestSeconds = 3;  ///< whoever is expected to take longer for a problem does not take part
  Patience patience = {};
};

/// What a contender took for a problem, round by round.
struct Run {
  const Program* program;
  int log2;
  std::string contender;
  bool isOurs;
  std::vector<double> seconds;
};

/// Who was left out of a race, and why.
struct Absence {
  std::string program;
  int log2;
  std::string contender;
  std::string why;
  bool isWrong;  ///< because its result was not what it must be
};

class Session {
 public:
  Session(const Settings& settings, const OurDevices& devices, const std::vector<Contender>& peers)
      : settings_(settings), devices_(devices), peers_(peers), awake_(devices.gl()) {}

  /// Prints the times of each problem as it goes, and calls `keep` after each program.
  void runAll(const std::function<void()>& keep);

  const std::vector<Run>& runs() const { return runs_; }
  const std::vector<Absence>& absences() const { return absences_; }

 private:
  struct Entry {
    Contender contender;
    bool isOurs;
  };

  void runProgram(const Program& program);
  void runProblem(const Program& program, int log2, bool withPeers);
  std::vector<Entry> entriesOf(const Program& program, bool withPeers) const;
  /// The task, which has run once and was right; none, and an absence, where it cannot be had.
  std::unique_ptr<Task> checkedTask(const Program& program, int log2, const Contender& contender,
                                    const Problem& problem, const Check& check);
  /// Prints and keeps the times of these runs, round by round.
  void tell(const std::vector<Run>& runs, const std::vector<std::vector<double>>& seconds);
  void leaveOut(const Program& program, int log2, const Contender& contender, std::string why, bool isWrong);

  const Settings& settings_;
  const OurDevices& devices_;
  const std::vector<Contender>& peers_;
  const Awake awake_;
  std::map<std::pair<std::string, std::string>, double>
      secondsPerWork_;  ///< of (program, contender), last seen
  std::vector<Run> runs_;
  std::vector<Absence> absences_;
};

}  // namespace race
