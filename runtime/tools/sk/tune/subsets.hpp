// SPDX-License-Identifier: MIT
//
// Chooses steps: as many as hold together, or as few as still hold. Pure functions of a predicate, which runs the program.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "tune/choices.hpp"

namespace sk_tool::tune {

using Steps = std::vector<Step>;
using Holds = std::function<bool(const Setting&)>;

Setting withAll(Setting setting, std::span<const Step> steps);

/// Adds steps to a setting as long as `holds` accepts the result: all at once, else halves of them, down to single ones. Leaves out steps
/// for what the setting, or an earlier step, has changed already.
void grow(Setting& setting, std::span<const Step> steps, const Holds& holds);

/// A smallest part of the steps that still holds together with the setting, which all of them do: no step can be left out of the result.
Steps shrink(const Setting& setting, Steps steps, const Holds& holds);

}  // namespace sk_tool::tune
