// SPDX-License-Identifier: MIT
//
// mpi_weak_scaling ROWS COLUMNS [STEPS [EXCHANGE_EVERY [OVERLAP]]]: the time of a step of `diffuse` on a torus with ROWS x
// COLUMNS elements per rank, on plain streams and on a domain, as medians of five rounds. With one rank, the quotient is
// what a domain costs; with several, their times beside that of one rank are the efficiency. Not a test.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "domain.sk.hpp"
#include "reductions.sk.hpp"
#include "sk/mpi.hpp"
#include "sk/sk.hpp"

namespace {

/// The median of the microseconds for a step. All ranks begin together, and the slowest counts.
template <class Step>
double timeOf(sk::Device& device, int steps, Step&& step) {
  std::vector<double> rounds;
  for (int round = 0; round < 6; ++round) {
    device.finish();
    MPI_Barrier(MPI_COMM_WORLD);
    const double begin = MPI_Wtime();
    for (int k = 0; k < steps; ++k) step();
    device.finish();
    double time = MPI_Wtime() - begin, slowest = 0;
    MPI_Allreduce(&time, &slowest, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    if (round > 0) rounds.push_back(slowest / steps * 1e6);  // the first one compiles
  }
  std::ranges::sort(rounds);
  return rounds[rounds.size() / 2];
}

void measure(std::int64_t rows, std::int64_t columns, int steps, int every, bool overlap) {
  int ranks = 1, rank = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {rows * ranks, columns},
                                     .periodic = {true, true},
                                     .split = {ranks, 1},
                                     .exchangeEvery = every,
                                     .overlap = overlap});
  const auto start = [](const sk::Index& i) { return static_cast<float>((i[0] * 7 + i[1]) % 13); };
  double plain = 0;
  {
    auto u = domain.device().stream<float>({rows, columns}),
         v = domain.device().stream<float>({rows, columns});
    u.fill(1.0F);
    plain = timeOf(domain.device(), steps, [&] {
      diffuse(0.2F, u, v);
      std::swap(u, v);
    });
  }
  auto u = domain.stream<float>(), v = domain.stream<float>();
  u.fill(start);
  domain.resetStatistics();
  const double divided = timeOf(domain.device(), steps, [&] {
    diffuse(0.2F, u, v);
    std::swap(u, v);
  });
  const sk::DomainStatistics sent = domain.statistics();
  const double total =
      timeOf(domain.device(), 10, [&] { (void)sum.with({.accumulate = sk::Accumulate::Exact})(u); });
  if (rank != 0) return;
  std::printf(
      "%s, %d ranks of %lld x %lld, every %d, overlap %d: plain %.1f us, domain %.1f us, quotient %.3f\n",
      domain.device().name().c_str(), ranks, static_cast<long long>(rows), static_cast<long long>(columns),
      every, overlap ? 1 : 0, plain, divided, plain / divided);
  std::printf("  %lld messages and %lld bytes in %d steps; an exact sum of all takes %.1f us\n",
              static_cast<long long>(sent.messages), static_cast<long long>(sent.bytes), 6 * steps, total);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const auto number = [&](int at, long long otherwise) {
    return argc > at ? std::atoll(argv[at]) : otherwise;
  };
  try {
    measure(number(1, 1024), number(2, 1024), static_cast<int>(number(3, 100)),
            static_cast<int>(number(4, 1)), number(5, 1) != 0);
  } catch (const sk::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
}
