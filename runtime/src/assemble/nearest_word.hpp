// SPDX-License-Identifier: MIT
//
// The word that somebody meant who typed another: for messages of skc's and sk's command lines.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sk::assemble {

/// The one of `known` that takes the fewest insertions, removals, replacements and exchanges of neighbours to make of
/// `word` (the optimal string alignment distance); "" where more than one and more than a third of its letters would change.
std::string_view nearestWord(std::string_view word, std::span<const std::string> known);

}  // namespace sk::assemble
