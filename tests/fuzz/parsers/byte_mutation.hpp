// SPDX-License-Identifier: MIT
//
// Nearly valid files of any format: a file of the corpus after a few random changes to its bytes, its numbers or its
// pieces. mutation.hpp changes programs instead.
#pragma once

#include <span>
#include <string>

#include "random.hpp"

namespace fuzz {

/// A mutant of one of the seeds, of which there must be at least one. Deterministic for the seeds and the state of `random`.
std::string mutatedBytes(std::span<const std::string> seeds, Random& random);

}  // namespace fuzz
