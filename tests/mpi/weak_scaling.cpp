// SPDX-License-Identifier: MIT
//
// mpi_weak_scaling ROWS COLUMNS [STEPS [EXCHANGE_EVERY [OVERLAP [convection]]]]: the time of a step of heat on a torus, or of the
// example lattice's convection between plates, with ROWS x COLUMNS elements per rank, on plain streams and on a domain, as medians of
// nine rounds. With one rank, the quotient is what a domain costs; with several, it is the efficiency. Both compute the same noise, and
// with coefficients of 0 it stays: GPUs store smooth textures compressed, and are up to 1.7 times as fast with them. Not a test.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "domain.sk.hpp"
#include "flow.sk.hpp"
#include "heat.sk.hpp"
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

/// Noise, by the index in the whole.
float noiseAt(const sk::Index& i) {
  const auto bits =
      static_cast<std::uint32_t>(i[0]) * 2654435761U + static_cast<std::uint32_t>(i[1]) * 40503U;
  return static_cast<float>((bits * 2246822519U) >> 8);
}

/// What a step reads and what it writes, in streams of either kind.
template <class Stream>
class Heat {
 public:
  template <class Make>
  explicit Heat(Make&& make) : u_(make()), v_(make()) {}
  void step() {
    spread(0.0F, u_, v_);
    std::swap(u_, v_);
  }
  Stream& first() { return u_; }

 private:
  Stream u_, v_;
};

template <class Stream>
class Convection {
 public:
  template <class Make>
  explicit Convection(Make&& make)
      : now_{make(), make(), make(), make()}, next_{make(), make(), make(), make()} {}
  void step() {
    constexpr int wrap = 0, wall = 2;  // Edge, in boundary.sk
    lattice::push(false, true, false, lattice::Fluid{}, now_.x, now_.y, now_.p, now_.t, next_.x, next_.y);
    lattice::convect(wrap, wrap, wall, wall, sk::float4{}, 0.0F, 0.0F, 0.0F, now_.t, next_.x, next_.y, now_.p,
                     next_.t, next_.p);
    std::swap(now_, next_);
  }
  Stream& first() { return now_.x; }

 private:
  struct Fields {
    Stream x, y, p, t;
  };
  Fields now_, next_;
};

template <template <class> class Model>
void measure(std::int64_t rows, std::int64_t columns, int steps, int every, bool overlap) {
  int ranks = 1, rank = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {rows * ranks, columns},
                                     .periodic = {true, true},
                                     .split = {ranks, 1},
                                     .exchangeEvery = every,
                                     .overlap = overlap});
  std::vector<double> plain;
  {
    std::vector<float> noise;
    noise.reserve(static_cast<std::size_t>(rows * columns));
    for (sk::Index i{0, 0}; i[0] < rows; ++i[0]) {
      for (i[1] = 0; i[1] < columns; ++i[1]) noise.push_back(noiseAt(i));
    }
    Model<sk::Stream<float>> model([&] {
      auto stream = domain.device().stream<float>({rows, columns});
      stream.write(noise);
      return stream;
    });
    plain = timesOf(domain.device(), steps, [&] { model.step(); });
  }
  Model<sk::DomainStream<float>> model([&] {
    auto stream = domain.stream<float>();
    stream.fill(noiseAt);
    return stream;
  });
  domain.resetStatistics();
  std::int64_t stepped = 0;
  const std::vector<double> divided = timesOf(domain.device(), steps, [&] {
    model.step();
    ++stepped;
  });
  const sk::DomainStatistics sent = domain.statistics();
  const std::vector<double> total = timesOf(
      domain.device(), 10, [&] { (void)sum.with({.accumulate = sk::Accumulate::Exact})(model.first()); });
  if (rank != 0) return;
  std::printf(
      "%s, %d ranks of %lld x %lld, every %d, overlap %d: plain %.1f us (%.1f to %.1f), domain %.1f us (%.1f "
      "to %.1f), quotient %.3f\n",
      domain.device().name().c_str(), ranks, static_cast<long long>(rows), static_cast<long long>(columns),
      every, overlap ? 1 : 0, median(plain), plain.front(), plain.back(), median(divided), divided.front(),
      divided.back(), median(plain) / median(divided));
  const std::int64_t exchanges = std::max<std::int64_t>(sent.exchanges, 1);
  std::printf(
      "  %.2f exchanges a step, each of %lld messages and %lld bytes; an exact sum of all takes %.1f us\n",
      static_cast<double>(sent.exchanges) / static_cast<double>(stepped),
      static_cast<long long>(sent.messages / exchanges), static_cast<long long>(sent.bytes / exchanges),
      median(total));
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const auto number = [&](int at, long long otherwise) {
    return argc > at ? std::atoll(argv[at]) : otherwise;
  };
  try {
    const bool isConvection = argc > 6 && std::string_view(argv[6]) == "convection";
    (isConvection ? measure<Convection> : measure<Heat>)(number(1, 1024), number(2, 1024),
                                                         static_cast<int>(number(3, 100)),
                                                         static_cast<int>(number(4, 1)), number(5, 1) != 0);
  } catch (const sk::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
}
