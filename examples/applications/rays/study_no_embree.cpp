// SPDX-License-Identifier: MIT
#include <stdexcept>

#include "study.hpp"

namespace rays {

Findings studyEmbree(sk::Device&, bool) {
  throw std::runtime_error(
      "this program was built without Embree; install libembree-dev, and configure with -DSK_EMBREE=ON");
}

}  // namespace rays
