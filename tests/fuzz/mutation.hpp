// SPDX-License-Identifier: MIT
//
// Programs that somebody has typed wrongly: a program of the corpus after a few random changes to its tokens, its
// lines or its bytes.
#pragma once

#include <string>

#include "corpus.hpp"
#include "random.hpp"

namespace fuzz {

/// The path is that of the program it began as. The same for the same corpus, seed and number.
Program mutant(const Corpus& corpus, Random& random);

}  // namespace fuzz
