// SPDX-License-Identifier: MIT
//
// mpi_weak_scaling ROWS COLUMNS [STEPS [EXCHANGE_EVERY [OVERLAP]]]: the time of a step of heat on a torus with ROWS x
// COLUMNS elements per rank, on plain streams and on a domain, as medians of five rounds. With one rank, the quotient is
// what a domain costs; with several, their times beside that of one rank are the efficiency. Both compute the same noise, and with
// k = 0 it stays: GPUs store smooth textures compressed, and are up to 1.7 times as fast with them. Not a test.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "domain.sk.hpp"
#include "reductions.sk.hpp"
#include "sk/mpi.hpp"
#include "sk/sk.hpp"

namespace {

/// The microseconds for a step in each of several rounds, sorted. All ranks begin together, and the slowest counts. Before
/// them, a second of rounds that do not count: they compile, and a GPU that was idle takes its time to clock up.
template <class Step>
std::vector<double> timesOf(sk::Device& device, int steps, Step&& step) {
  std::vector<double> rounds;
  const double start = MPI_Wtime();
  for (int isWarm = 0; rounds.size() < 9;) {
    device.finish();
    MPI_Barrier(MPI_COMM_WORLD);
    const double begin = MPI_Wtime();
    for (int k = 0; k < steps; ++k) step();
    device.finish();
    double time = MPI_Wtime() - begin, slowest = 0;
    MPI_Allreduce(&time, &slowest, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    if (isWarm != 0) rounds.push_back(slowest / steps * 1e6);
    isWarm = MPI_Wtime() - start > 1 ? 1 : 0;
    MPI_Bcast(&isWarm, 1, MPI_INT, 0, MPI_COMM_WORLD);
  }
  std::ranges::sort(rounds);
  return rounds;
}

double median(const std::vector<double>& sorted) { return sorted[sorted.size() / 2]; }

void measure(std::int64_t rows, std::int64_t columns, int steps, int every, bool overlap) {
  int ranks = 1, rank = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {rows * ranks, columns},
                                     .periodic = {true, true},
                                     .split = {ranks, 1},
                                     .exchangeEvery = every,
                                     .overlap = overlap});
  const auto start = [](const sk::Index& i) {
    const auto bits =
        static_cast<std::uint32_t>(i[0]) * 2654435761U + static_cast<std::uint32_t>(i[1]) * 40503U;
    return static_cast<float>((bits * 2246822519U) >> 8);
  };
  std::vector<double> plain;
  {
    auto u = domain.device().stream<float>({rows, columns}),
         v = domain.device().stream<float>({rows, columns});
    std::vector<float> noise;
    noise.reserve(static_cast<std::size_t>(rows * columns));
    for (sk::Index i{0, 0}; i[0] < rows; ++i[0]) {
      for (i[1] = 0; i[1] < columns; ++i[1]) noise.push_back(start(i));
    }
    u.write(noise);
    plain = timesOf(domain.device(), steps, [&] {
      spread(0.0F, u, v);
      std::swap(u, v);
    });
  }
  auto u = domain.stream<float>(), v = domain.stream<float>();
  u.fill(start);
  domain.resetStatistics();
  const std::vector<double> divided = timesOf(domain.device(), steps, [&] {
    spread(0.0F, u, v);
    std::swap(u, v);
  });
  const sk::DomainStatistics sent = domain.statistics();
  const std::vector<double> total =
      timesOf(domain.device(), 10, [&] { (void)sum.with({.accumulate = sk::Accumulate::Exact})(u); });
  if (rank != 0) return;
  std::printf(
      "%s, %d ranks of %lld x %lld, every %d, overlap %d: plain %.1f us (%.1f to %.1f), domain %.1f us (%.1f "
      "to %.1f), quotient %.3f\n",
      domain.device().name().c_str(), ranks, static_cast<long long>(rows), static_cast<long long>(columns),
      every, overlap ? 1 : 0, median(plain), plain.front(), plain.back(), median(divided), divided.front(),
      divided.back(), median(plain) / median(divided));
  const std::int64_t exchanges = std::max<std::int64_t>(sent.exchanges, 1);
  std::printf("  an exchange takes %lld messages and %lld bytes; an exact sum of all takes %.1f us\n",
              static_cast<long long>(sent.messages / exchanges),
              static_cast<long long>(sent.bytes / exchanges), median(total));
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
