// SPDX-License-Identifier: MIT
//
// The list of the peers written with OpenMP.
#include "peers/cpu_task.hpp"
#include "peers/openmp/all.hpp"
#include "rays_layout.hpp"

RACE_ADD_PEERS(std::vector<race::Contender>& contenders) {
  using namespace race;
  const auto add = [&](const char* program, auto resultSize, auto function) {
    contenders.push_back(onCpu(program, "OpenMP", resultSize, function));
  };
  add("saxpy", asMany, saxpyOpenMp);
  add("sum", one, sumOpenMp);
  add("compensated sum", one, compensatedSumOpenMp);
  add("dot", one, dotOpenMp);
  add("folded output", [](const Problem& p) { return p.size() + 1; }, residualOpenMp);
  add("5-point stencil", asMany, heatOpenMp);
  add("9-point stencil", asMany, binomialOpenMp);
  add("mandelbrot", asMany, mandelbrotOpenMp);
  add("sgemv", [](const Problem& p) { return p.rows; }, gemvOpenMp);
  add("sgemm", asMany, gemmOpenMp);
  contenders.push_back({"prefix scan", "OpenMP", scanOpenMp});
  contenders.push_back({"compaction", "serial", compactionSerial});
  contenders.push_back({"compaction", "OpenMP", compactionOpenMp});
  add("sort", asMany, sortOpenMp);
  add("sort of pairs", asMany, sortPairsOpenMp);
  add("n-body", [](const Problem& p) { return 3 * p.size(); }, bodiesOpenMp);
  contenders.push_back({"fft", "OpenMP", fourierOpenMp});
  contenders.push_back({"gray-scott", "OpenMP", reactionOpenMp});
  contenders.push_back({"boiling step", "OpenMP", boilingOpenMp});
  contenders.push_back({"convection step", "OpenMP", convectionOpenMp});
  contenders.push_back({"reaction step", "OpenMP", reactionStepOpenMp});
  contenders.push_back({"cloth step", "OpenMP", clothOpenMp});
  for (const char* program : rayPrograms) add(program, twoEach, raysOpenMp);
  add("sparse matrix", asMany, sparseOpenMp);
  add("power-law matrix", asMany, sparseOpenMp);
  contenders.push_back({"5-point matrix", "OpenMP", diagonalsOpenMp});
  contenders.push_back({"conjugate gradients", "OpenMP", gradientsOpenMp});
  contenders.push_back({"heat loop", "OpenMP", heatLoopOpenMp});
  contenders.push_back({"gray-scott loop", "OpenMP", reactionLoopOpenMp});
  contenders.push_back({"wave loop", "OpenMP", waveLoopOpenMp});
  contenders.push_back({"chain of four", "OpenMP", chainOpenMp});
}
