// SPDX-License-Identifier: MIT
//
// Promises: the programs that call kernels of applications and the solvers give what is checked, as do their peers. (Applications
// change, and sk_race itself is no part of the tests.)
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "check.hpp"
#include "peers/openmp/all.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

struct Applied {
  const char* name;
  Problem (*problem)(int log2);
  Check (*check)(const Problem& problem);
  MakeOurs ours;
  std::unique_ptr<Task> (*openMp)(const Problem& problem);
};

const Applied applied[] = {
    {"boiling step", boilingProblem, boilingCheck, boilingOurs, boilingOpenMp},
    {"convection step", convectionProblem, convectionCheck, convectionOurs, convectionOpenMp},
    {"reaction step", reactionStepProblem, reactionStepCheck, reactionStepOurs, reactionStepOpenMp},
    {"cloth step", clothProblem, clothCheck, clothOurs, clothOpenMp},
    {"5-point matrix", diagonalsProblem, nullptr, diagonalsOurs, diagonalsOpenMp},
    {"conjugate gradients", gradientsProblem, gradientsCheck, gradientsOurs, gradientsOpenMp},
};

std::vector<float> resultOf(Task& task) {
  task.run(1);
  return task.result();
}

TEST_CASE("programs of applications and solvers give what is checked") {
  sk::Device device("native");
  for (const Applied& program : applied) {
    INFO(program.name);
    const Problem p = program.problem(12);
    const std::vector<float> ours = resultOf(*program.ours(device, {}, p));
    const std::vector<float> peers = resultOf(*program.openMp(p));
    // The check of sparse matrices belongs to a program that is not tested here; the peer's product is one.
    const Check check = program.check != nullptr
                            ? program.check(p)
                            : Check{{}, std::vector<double>(peers.begin(), peers.end()), 1e-5};
    CHECK(faultOf(ours, check).value_or("") == "");
    CHECK(faultOf(peers, check).value_or("") == "");
  }
}

}  // namespace
}  // namespace race
