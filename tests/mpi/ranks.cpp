// SPDX-License-Identifier: MIT
//
// main() of the tests on ranks: all ranks run the same test cases.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "ranks.hpp"

int rankOfWorld() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int ranksOfWorld() {
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return ranks;
}

namespace {

/// Other ranks would wait for one that has left a test case.
struct EndAll : Catch::TestEventListenerBase {
  using TestEventListenerBase::TestEventListenerBase;

  void testCaseEnded(const Catch::TestCaseStats& stats) override {
    TestEventListenerBase::testCaseEnded(stats);
    hasFailed = hasFailed || stats.totals.assertions.failed > 0;
  }
  void testCaseStarting(const Catch::TestCaseInfo& info) override {
    TestEventListenerBase::testCaseStarting(info);
    if (hasFailed) MPI_Abort(MPI_COMM_WORLD, 1);
  }
  ~EndAll() override {
    if (hasFailed) MPI_Abort(MPI_COMM_WORLD, 1);
  }

  bool hasFailed = false;
};
CATCH_REGISTER_LISTENER(EndAll)

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const int failed = Catch::Session().run(argc, argv);
  MPI_Finalize();
  return failed == 0 ? 0 : 1;
}
