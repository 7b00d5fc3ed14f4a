// SPDX-License-Identifier: MIT
//
// The known word that is most similar to a mistyped one: for messages about command lines and configuration
// files.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sk::assemble {

/// The word of `known` that needs the fewest insertions, deletions, replacements and swaps of neighbours (the
/// optimal string alignment distance); "" if more than one letter and more than a third of `word` would
/// change.
std::string_view nearestWord(std::string_view word, std::span<const std::string> known);

}  // namespace sk::assemble
