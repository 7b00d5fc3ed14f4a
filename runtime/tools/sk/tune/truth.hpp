// SPDX-License-Identifier: MIT
//
// The right results: those of the same program on the reference device, which computes in doubles. They are kept in the folder of
// SK_CACHE, by the command line, the contents of the program and of files that it names, and the environment.
#pragma once

#include "tune/application.hpp"

namespace sk_tool::tune {

struct Truth {
  sk::results::Process process;
  bool isCached = false;
  double wall = 0;  ///< seconds of the run
};

/// Runs the program on the reference device, unless its results are known and not `isFresh`. Throws std::runtime_error if it does not
/// run there.
Truth truthOf(const Application& application, bool isFresh);

}  // namespace sk_tool::tune
