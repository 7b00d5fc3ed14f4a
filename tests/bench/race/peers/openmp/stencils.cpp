// SPDX-License-Identifier: MIT
#include "peers/openmp/stencil.hpp"

#include "constants.hpp"
#include "peers/openmp/all.hpp"

namespace race {

void heatOpenMp(const Problem& p, float* v) { heatStep(p.rows, p.columns, heatFlow, p.floats[0].data(), v); }

void binomialOpenMp(const Problem& p, float* v) {
  stencil(p.rows, p.columns, p.floats[0].data(), v,
          [](const float* above, const float* row, const float* below, auto left, auto x, auto right) {
            const float corners = above[left] + above[right] + below[left] + below[right];
            const float sides = above[x] + row[left] + row[right] + below[x];
            return (corners + 2 * sides + 4 * row[x]) / 16;
          });
}

}  // namespace race
