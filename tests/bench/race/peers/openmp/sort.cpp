// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <parallel/algorithm>
#include <vector>

#include "peers/openmp/all.hpp"

namespace race {

// What libstdc++ has for this: its parallel mode, on OpenMP.
void sortOpenMp(const Problem& p, float* sorted) {
  std::copy(p.floats[0].begin(), p.floats[0].end(), sorted);
  __gnu_parallel::sort(sorted, sorted + p.size());
}

void sortPairsOpenMp(const Problem& p, float* sorted) {
  struct Pair {
    float key, value;
  };
  static std::vector<Pair> pairs;  // as the streams of ours, kept between runs
  pairs.resize(static_cast<std::size_t>(p.size()));
  std::transform(p.floats[0].begin(), p.floats[0].end(), pairs.begin(),
                 [](float key) { return Pair{key, 2 * key}; });
  __gnu_parallel::stable_sort(pairs.begin(), pairs.end(),
                              [](const Pair& a, const Pair& b) { return a.key < b.key; });
  std::transform(pairs.begin(), pairs.end(), sorted, [](const Pair& pair) { return pair.value; });
}

}  // namespace race
