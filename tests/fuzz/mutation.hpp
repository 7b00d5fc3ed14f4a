// SPDX-License-Identifier: MIT
//
// Programs with mistakes: a program of the corpus after a few random changes to its tokens, its lines or its bytes.
#pragma once

#include <string>

#include "corpus.hpp"
#include "random.hpp"

namespace fuzz {

/// A mutant, with the path of its original. Deterministic for a corpus and the state of `random`.
Program mutant(const Corpus& corpus, Random& random);

}  // namespace fuzz
