// SPDX-License-Identifier: MIT
#include "tune/search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <span>

#include <fmt/format.h>

#include "tune/subsets.hpp"

namespace sk_tool::tune {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// More rounds for short runs, whose times vary more.
int roundsFor(const Trial& trial) { return trial.median() < 0.5 ? 5 : 3; }

/// The seconds that a trial saves over another one: in a kernel, if its times are known, which other work on the machine changes
/// less than those of the whole.
double secondsSaved(const std::string& kernel, const Trial& trial, const Trial& before) {
  const auto first = before.kernels.find(kernel), second = trial.kernels.find(kernel);
  if (first != before.kernels.end() && second != trial.kernels.end()) return first->second - second->second;
  return before.least() - trial.least();
}

/// The kernel whose times show what a unit does; "" for streams.
std::string kernelOf(const Unit& unit) { return unit.section == "kernels" ? unit.name : ""; }

/// What a choice does, from runs without it and with it in turns; `rest` is the trial without it.
Evidence evidenceOf(const Comparison& comparison, const Trial& rest, const Trial& base) {
  return {.saved = comparison.saved() / std::max(base.median(), 1e-9),
          .isTimed = true,
          .scoreWithout = rest.verdict.score};
}

class CheaperSearch {
 public:
  CheaperSearch(Trials& trials, const Choices& choices, Found& found)
      : trials_(trials), choices_(choices), found_(found), start_(found.setting) {}

  void run() {
    lowerTogether();
    Steps promising = tryEach();
    const auto isNew = [&](const Step& step) {
      return std::ranges::none_of(step.changes,
                                  [&](const auto& change) { return found_.setting.contains(change.first); });
    };
    const auto again = std::ranges::stable_partition(promising, isNew);
    for (const Step& step : again) {
      const Setting setting = with(found_.setting, step.changes);
      if (isBetter(setting)) found_.setting = setting;
    }
    promising.erase(again.begin(), again.end());
    grow(found_.setting, promising, [&](const Setting& setting) { return isBetter(setting); });
    leaveOutEach();
  }

 private:
  bool isOpen(const Step& step) const {
    return std::ranges::none_of(step.changes,
                                [&](const auto& change) { return start_.contains(change.first); });
  }

  /// Wide numbers become floats, except for the fewest that must stay wide.
  void lowerTogether() {
    Steps steps = choices_.lowered;
    std::erase_if(steps, [&](const Step& step) { return !isOpen(step); });
    if (steps.size() < 2) return;  // tryEach() tries a single one
    const Setting all = withAll(start_, steps);
    const auto holdsWith = [&](const Setting& wide) {
      return trials_.holds(trials_.run(without(all, wide)));
    };
    const Steps wide = holdsWith({}) ? Steps() : shrink({}, steps, holdsWith);
    const Setting lowered = without(all, withAll({}, wide));
    if (lowered != start_ && isBetter(lowered)) found_.setting = lowered;
  }

  /// The choices that save time and hold the tolerance by themselves, the best first.
  Steps tryEach() {
    struct Candidate {
      Step step;
      double value;
    };
    const Setting now = found_.setting;
    const Trial& base = trials_.run(now);
    std::vector<Candidate> candidates;
    for (const Step& step : choices_.others) {
      const Setting setting = with(now, step.changes);
      if (!isOpen(step) || setting == now) continue;
      const Trial& trial = trials_.run(setting);
      if (!trial.failure.empty()) {
        found_.failed.push_back(fmt::format("{}: the program {}", describe(step.changes), trial.failure));
      }
      if (trial.failure.empty() && !trials_.isAllowed(trial)) {
        found_.failed.push_back(fmt::format("{}: {} (--allow-decisions lets it)", describe(step.changes),
                                            trial.verdict.decision));
      }
      if (!trials_.holds(trial)) continue;
      const double first = savedBy(step, trial, base);
      const bool isClear = std::fabs(first) >= 0.5 * base.least();
      // A first run builds programs, which devices that queue calls may do in later calls, too.
      if (!isClear || (first < 0 && trials_.measures())) trials_.time(setting, first > 0 || isClear ? 2 : 3);
      const double saved = savedBy(step, trial, base);
      if (saved <= leastGain * base.median()) continue;
      const double error = std::max(trial.verdict.score - base.verdict.score, 1e-12);
      candidates.push_back({step, saved / error});
    }
    std::ranges::stable_sort(candidates, std::greater(), &Candidate::value);
    Steps steps;
    for (Candidate& each : candidates) steps.push_back(std::move(each.step));
    return steps;
  }

  static double savedBy(const Step& step, const Trial& trial, const Trial& base) {
    return secondsSaved(step.isKernel ? step.of : "", trial, base);
  }

  bool isBetter(const Setting& setting) {
    const Trial& trial = trials_.run(setting);
    if (!trials_.holds(trial) || slower_.contains(setting)) return false;
    const bool isFaster = trials_.compare(found_.setting, setting, roundsFor(trial)).isFaster(leastGain / 2);
    if (!isFaster) slower_.insert(setting);
    return isFaster;
  }

  /// Leaves out each choice once: this shows what it saves and how exact the rest is, and drops it if it saves nothing.
  void leaveOutEach() {
    const Setting all = found_.setting;
    const Trial& base = trials_.run({});
    for (const auto& [unit, value] : all) {
      if (start_.contains(unit)) continue;
      const Setting rest = without(found_.setting, {{unit, value}});
      const Trial& trial = trials_.run(rest);
      found_.evidence[unit] = {.scoreWithout = trial.failure.empty() ? trial.verdict.score : infinite};
      if (!trials_.holds(trial)) continue;
      const Comparison comparison = trials_.compare(rest, found_.setting, roundsFor(trial), kernelOf(unit));
      found_.evidence[unit] = evidenceOf(comparison, trial, base);
      if (comparison.isFaster(0) && found_.evidence[unit].saved > leastGain) continue;
      found_.setting = rest;
      found_.evidence.erase(unit);
    }
    for (auto& [unit, evidence] : found_.evidence) {  // some others have been dropped since
      const Trial& trial = trials_.run(without(found_.setting, {{unit, {}}}));
      evidence.scoreWithout = trial.failure.empty() ? trial.verdict.score : infinite;
    }
  }

  Trials& trials_;
  const Choices& choices_;
  Found& found_;
  const Setting start_;
  std::set<Setting> slower_;  ///< settings that were no faster than what they add to
};

class ExactSearch {
 public:
  ExactSearch(Trials& trials, const Choices& choices, Found& found)
      : trials_(trials), choices_(choices), found_(found) {}

  void run() {
    const Steps steps = runnable();
    const Setting all = withAll({}, steps);
    keepBest(trials_.run(all));
    if (!trials_.holds(trials_.run(all))) {
      found_.isReached = false;
      return;
    }
    found_.setting = all;
    const auto holds = [&](const Setting& setting) {
      const Trial& trial = trials_.run(setting);
      if (trials_.holds(trial) && setting.size() < found_.setting.size()) found_.setting = setting;
      return trials_.holds(trial);
    };
    const Steps needed = shrink({}, steps, holds);
    found_.setting = withAll({}, needed);
    for (const Step& step : needed) found_.raised.push_back(step.of);
    leaveOutKeys();
    timeEach(needed);
  }

 private:
  /// The steps with which, together, the program runs and keeps its decisions.
  Steps runnable() {
    const auto isAllowed = [&](const Setting& setting) {
      const Trial& trial = trials_.run(setting);
      keepBest(trial);
      return trials_.isAllowed(trial);
    };
    if (isAllowed(withAll({}, choices_.raised))) return choices_.raised;
    Setting setting;
    grow(setting, choices_.raised, isAllowed);
    Steps steps;
    for (const Step& step : choices_.raised) {
      const bool isIn = std::ranges::all_of(step.changes, [&](const auto& change) {
        const auto own = setting.find(change.first);
        return own != setting.end() && own->second == change.second;
      });
      if (isIn) {
        steps.push_back(step);
      } else {
        noteFailure(step);
      }
    }
    return steps;
  }

  void noteFailure(const Step& step) {
    const Trial& trial = trials_.run(step.changes);
    const std::string why = trial.failure.empty() ? (trial.verdict.decision.empty()
                                                         ? "the program does not run with it and the others"
                                                         : trial.verdict.decision)
                                                  : "the program " + trial.failure;
    found_.failed.push_back(fmt::format("{}: {}", describe(step.changes), why));
  }

  /// Until a setting holds, the most exact one is the result.
  void keepBest(const Trial& trial) {
    if (trials_.isAllowed(trial) && trial.verdict.score < bestScore_) {
      bestScore_ = trial.verdict.score;
      found_.setting = trial.setting;
    }
  }

  /// A kernel that is raised by several keys may not need all of them.
  void leaveOutKeys() {
    const Setting all = found_.setting;
    std::map<std::string, int> keys;
    for (const auto& [unit, value] : all) ++keys[unit.name];
    for (const auto& [unit, value] : all) {
      if (keys[unit.name] < 2) continue;
      const Setting rest = without(found_.setting, {{unit, value}});
      if (!trials_.holds(trials_.run(rest))) continue;
      found_.setting = rest;
      --keys[unit.name];
    }
  }

  void timeEach(const Steps& needed) {
    const Trial& base = trials_.run({});
    for (const Step& step : needed) {
      const Setting rest = without(found_.setting, step.changes);
      const Trial& trial = trials_.run(rest);
      Evidence evidence{.scoreWithout = infinite};
      if (trial.failure.empty()) {
        const std::string kernel = step.isKernel ? step.of : "";
        evidence = evidenceOf(trials_.compare(rest, found_.setting, roundsFor(trial), kernel), trial, base);
      }
      for (const auto& [unit, value] : step.changes) {
        if (found_.setting.contains(unit)) found_.evidence[unit] = evidence;
      }
    }
  }

  Trials& trials_;
  const Choices& choices_;
  Found& found_;
  double bestScore_ = infinite;
};

/// The fastest setting so far that holds and has run more than once.
Setting fastestTried(Trials& trials, const Setting& start) {
  const Trial* fastest = &trials.run(start);
  for (const Trial* trial : trials.all()) {
    if (trial->seconds.size() < 2 || !trials.holds(*trial)) continue;
    if (trial->least() < (1 - leastGain) * fastest->least()) fastest = trial;
  }
  return fastest->setting;
}

}  // namespace

void searchCheaper(Trials& trials, const Choices& choices, Found& found) {
  const Setting start = found.setting;
  try {
    CheaperSearch(trials, choices, found).run();
  } catch (const OutOfBudget&) {
    found.isComplete = false;
    if (found.setting == start) found.setting = fastestTried(trials, start);
  }
}

void searchExact(Trials& trials, const Choices& choices, Found& found) {
  try {
    ExactSearch(trials, choices, found).run();
  } catch (const OutOfBudget&) {
    found.isComplete = false;
    found.isReached = trials.holds(trials.run(found.setting));
  }
}

}  // namespace sk_tool::tune
