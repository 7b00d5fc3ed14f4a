// SPDX-License-Identifier: MIT
#include "direct.hpp"

#include <sk/error.hpp>

namespace linear {

DirectSolution solveDirectly(const Operator&, std::span<const double>) {
  throw sk::Error(
      "direct solutions need Eigen, which was not found when this program was built (Debian: libeigen3-dev)");
}

}  // namespace linear
