// SPDX-License-Identifier: MIT
//
// The search for the cheapest setting that is exact enough.
//
// Where the program is exact enough as it is (searchCheaper): if it computes in wide numbers, all of them become floats together, but for
// the fewest that must stay wide, as delta debugging finds them. Then each choice is tried alone; those that save time and hold the
// tolerance are added up, the most time saved per error first, halves of the list at a time where the whole does not hold. In the end,
// each is left out once, which shows what it saves, and drops it if that is nothing.
//
// Where it is not (searchExact): everything is raised that can be, and delta debugging (Zeller and Hildebrandt, IEEE Transactions on
// Software Engineering 28, 2002) finds a smallest set of kernels and streams that must stay so: none of them can be left out.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tune/choices.hpp"
#include "tune/trials.hpp"

namespace sk_tool::tune {

/// What is known of one choice of the result: what the program would be without it.
struct Evidence {
  double saved = 0;  ///< part of the time of the program as it is; below 0 if it costs some
  bool isTimed = false;
  double scoreWithout = 0;  ///< the score without it; infinite if the program does not run then
};

struct Found {
  Setting setting = {};
  std::map<Unit, Evidence> evidence = {};
  std::vector<std::string> raised = {};  ///< kernels and streams that had to be raised
  std::vector<std::string> failed = {};  ///< choices with which the program does not run, and why
  bool isComplete = true;  ///< false if the budget has ended the search
  bool isReached = true;  ///< false if nothing is exact enough; `setting` is then the most exact one
};

/// A choice that saves less than this part of the time is not worth what it may cost on other inputs.
inline constexpr double leastGain = 0.02;

/// Starts from a setting that holds. Changes nothing of it.
void searchCheaper(Trials& trials, const Choices& choices, Found& found);

/// Starts from the program as it is, which does not hold.
void searchExact(Trials& trials, const Choices& choices, Found& found);

}  // namespace sk_tool::tune
