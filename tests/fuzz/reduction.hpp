// SPDX-License-Identifier: MIT
//
// Shrinks a failing program while it still fails in the same way: delta debugging (Zeller and Hildebrandt, "Simplifying
// and isolating failure-inducing input", 2002), first on lines, then on tokens.
#pragma once

#include <functional>
#include <string>

namespace fuzz {

/// `fails(text)` returns whether a text still fails like the original.
std::string reduced(std::string text, const std::function<bool(const std::string&)>& fails);

}  // namespace fuzz
