// SPDX-License-Identifier: MIT
//
// Files that are nearly right, of any format: a file of the corpus after a few random changes to its bytes, its numbers or its
// pieces. Programs have changes of their own (mutation.hpp).
#pragma once

#include <span>
#include <string>

#include "random.hpp"

namespace fuzz {

/// The same for the same seeds (of which there is one at least) and random numbers.
std::string mutatedBytes(std::span<const std::string> seeds, Random& random);

}  // namespace fuzz
