// SPDX-License-Identifier: MIT
#include "numbers/shrink.hpp"

#include <algorithm>
#include <utility>

#include "numbers/generator.hpp"

namespace fuzz::numbers {

Shrunk shrunk(Case failing, std::string what, const FindFailure& find, int budget, std::size_t together) {
  Shrunk best{std::move(failing), std::move(what)};
  for (bool isSmaller = true; isSmaller && budget > 0;) {
    isSmaller = false;
    const std::vector<Case> candidates = simpler(best.smallest);
    for (std::size_t first = 0; first < candidates.size() && budget > 0 && !isSmaller; first += together) {
      const std::span part =
          std::span(candidates).subspan(first, std::min(together, candidates.size() - first));
      budget -= static_cast<int>(part.size());
      const std::optional<Failure> found = find(part);
      if (!found) continue;
      best = {part[found->number], found->what};
      isSmaller = true;
    }
  }
  return best;
}

}  // namespace fuzz::numbers
