// SPDX-License-Identifier: MIT
//
// Makes a program that fails smaller, as long as it fails in the same way (Zeller and Hildebrandt, "Simplifying
// and isolating failure-inducing input", 2002, on lines and then on tokens).
#pragma once

#include <functional>
#include <string>

namespace fuzz {

/// `fails(text)` says whether a text still fails as the first one does.
std::string reduced(std::string text, const std::function<bool(const std::string&)>& fails);

}  // namespace fuzz
