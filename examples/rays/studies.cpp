// SPDX-License-Identifier: MIT
#include <array>

#include "study.hpp"

namespace rays {

std::span<const Study> studies() {
  static constexpr std::array all = {
      Study{"leaks", "what tests of triangles miss at edges and vertices, and how exact their distances are",
            studyLeaks},
      Study{"needles", "how the errors of distances grow with the aspect ratio of triangles", studyNeedles},
      Study{"alike", "how far apart pictures are by every mode, on fragment, compute and native", studyAlike},
      Study{"light", "means of pictures that are known, by each way to reach lights", studyLight},
      Study{"convergence", "how fast errors fall with independent samples and with Sobol's",
            studyConvergence},
      Study{"precision", "what tests of triangles in halves, floats and doubles miss, and what they cost",
            studyPrecision},
      Study{"sums", "what sums of a million samples lose in floats", studySums},
      Study{"speed", "rays per second by test, traversal and size of leaves", studySpeed},
      Study{"wavefront", "paths by one kernel or by queues, and what sorting rays is worth", studyWavefront},
      Study{"streaming", "what a uniform grid and each kernel of a multipass machine cost", studyStreaming},
      Study{"stopping", "what it saves that pixels stop when they are good enough, and what is wrong then",
            studyStopping},
      Study{"ray_engine", "what sizes of buckets and calls are worth, and not to wait", studyRayEngine},
      Study{"engines", "the three engines on the scenes of the benchmarks", studyEngines},
      Study{"embree", "the same rays by Embree: rays per second, and hits that differ", studyEmbree},
  };
  return all;
}

}  // namespace rays
