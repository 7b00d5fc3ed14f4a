// SPDX-License-Identifier: MIT
//
// mpi_rank_faults [PROGRAM...]: small programs over ranks, in each of which the n-th opportunity of one rank fails, for n = 1, 2, 3 ...:
// allocations, functions of MPI and, where the ranks have GL devices, what drivers do. Promises: no rank hangs or crashes; if one rank
// throws, all do, at the latest at their next collective call; the same program then runs on all ranks, in the same domain, with the
// right results; and nothing is left over.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <unistd.h>

#include "faults.hpp"
#include "faults_of_mpi.hpp"
#include "rank_faults.sk.hpp"
#include "sk/mpi.hpp"

namespace {

constexpr std::array<bool, sk::maxRank> around = {true, true, true, true};
int rank = 0, ranks = 1;

/// What the watchdog says.
std::array<char, 200> now{};
void giveUp(int) {
  (void)!write(2, now.data(), std::strlen(now.data()));
  _exit(3);
}

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "rank %d: %s: %s\n", rank, now.data(), what.c_str());
  std::fflush(stderr);
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::abort();
}

/// Sums of all ranks, past the functions that fail.
int countOf(bool isSo) {
  int own = isSo ? 1 : 0, all = 0;
  PMPI_Allreduce(&own, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  return all;
}

template <class Call>
std::string errorOf(Call&& call) {
  try {
    call();
  } catch (const sk::Error& error) {
    return *error.what() == '\0' ? "an error without a text" : error.what();
  } catch (const std::exception& error) {
    fail(std::string("an exception that is no sk::Error: ") + error.what());
  }
  return {};
}

float start(const sk::Index& i) { return static_cast<float>((7 * i[0] + 3 * i[1]) % 11); }

/// Where the programs run.
struct Place {
  explicit Place(const std::string& folder)
      : domain(MPI_COMM_WORLD, {.shape = {16, 6}, .periodic = around, .split = {ranks, 1}}),
        coarse(domain, {.shape = {8, 3}, .periodic = around}),
        u(domain.stream<float>()),
        v(domain.stream<float>()),
        healthy(domain.stream<float>()),
        c(coarse.stream<float>()),
        whole(domain.device().stream<float>({16, 6})),
        total(domain.device().stream<float>({1})),
        file(folder + "/u.npy") {
    healthy.fill(1);
  }
  void reset() {
    u.fill(start);
    v.fill(0);
    c.fill(0);
    whole.fill(0);
    total.fill(0);
    values = {};
  }

  sk::Domain domain, coarse;
  sk::DomainStream<float> u, v, healthy, c;
  sk::Stream<float> whole, total;
  std::string file;
  std::array<float, 3> values{};
};

using Result = std::vector<float>;
struct Program {
  const char* name;
  void (*run)(Place& place);
  sk::DomainStream<float> Place::* result = nullptr;  ///< beside Place::values
  bool isFirst = false;  ///< runs in new domains, whose ranks compare each call
};

/// What the program has computed, on this rank.
Result resultOf(const Place& place, const Program& program) {
  Result result = program.result == nullptr ? Result{} : (place.*program.result).read();
  const std::vector<float> total = place.total.read();
  result.insert(result.end(), {place.values[0], place.values[1], place.values[2], total.front()});
  return result;
}

const std::vector<Program>& programs() {
  static const std::vector<Program> all = {
      {"halo map",
       [](Place& place) {
         diffuse(0.2F, place.u, place.v);
         diffuse(0.2F, place.v, place.u);
       },
       &Place::u},
      {"map without messages",
       [](Place& place) {
         scaled(2.0F, place.u, place.v);
         scaled(2.0F, place.v, place.v);
       },
       &Place::v},
      {"fold", [](Place& place) { product(place.u, place.u, place.v, place.total); }, &Place::v},
      {"reduce",
       [](Place& place) {
         place.values = {sum(place.u), sum.with({.accumulate = sk::Accumulate::Exact})(place.u),
                         slope(place.u, place.u)};
       }},
      {"reduce later",
       [](Place& place) {
         sk::Future<float> total = place.domain.later(sum, place.u);
         diffuse(0.2F, place.u, place.v);
         place.values[0] = total.get().front();
       },
       &Place::v},
      {"scan", [](Place& place) { running.with({.along = 0})(place.u, place.v); }, &Place::v},
      {"save and load",
       [](Place& place) {
         place.u.save(place.file);
         place.v.load(place.file);
       },
       &Place::v},
      {"gather and scatter",
       [](Place& place) {
         const std::vector<float> gathered = place.u.gather(1);
         place.v.scatter(gathered, 1);
       },
       &Place::v},
      {"whole copies",
       [](Place& place) {
         place.u.copyTo(place.whole);
         place.v.copyFrom(place.whole);
         place.v.copyTo(place.u);
       },
       &Place::u},
      {"two grids",
       [](Place& place) {
         restricted(place.u, place.c);
         diffuse(0.2F, place.c, place.c);
       },
       &Place::c},
      {"a deeper halo",
       [](Place& place) {
         sk::DomainStream<float> w = place.domain.stream<float>();
         w.fill(2.0F);
         diffuse(0.2F, w, place.v);
         place.values[0] = slope(w, place.v);
       },
       &Place::v},
      {"first calls",
       [](Place& place) {
         scaled(2.0F, place.u, place.v);
         running.with({.along = 0})(place.u, place.u);
         diffuse(0.2F, place.v, place.v);
         place.values = {sum(place.u), slope(place.v, place.u)};
         place.u.fill(start);
         static constexpr std::array<float, 16 * 6> zeros{};
         const sk::Box own = place.v.own();
         place.v.write(std::span(zeros).first(static_cast<std::size_t>(6 * (own.end[0] - own.begin[0]))));
       },
       &Place::v, true},
      {"a domain",
       [](Place& place) {
         sk::Domain other(MPI_COMM_WORLD, {.shape = {16, 6}});
         place.values[0] = static_cast<float>(other.shape()[0]);
       }},
      {"a domain beside",
       [](Place& place) {
         sk::Domain fine(place.domain, {.shape = {32, 12}, .periodic = around});
         auto w = fine.stream<float>();
         w.fill(2.0F);
         restricted(w, place.v);
       },
       &Place::v},
  };
  return all;
}

struct Counts {
  long faults = 0, harmless = 0, together = 0, atNext = 0;
};

/// What fails on one rank.
struct Fails {
  std::optional<faults::Kind> kind;  ///< empty: functions of MPI
  long step = 1;  ///< between the opportunities from the 16th on, which are much alike

  std::string name() const { return kind ? faults::nameOf(*kind) : "MPI"; }
};

std::vector<Fails> failing(bool isNative) {
  using faults::Kind;
  if (isNative) return {{std::nullopt}, {Kind::Host, 6}};
  return {{Kind::Host, 40}, {Kind::Allocation, 6}, {Kind::Program, 20}, {Kind::Framebuffer, 6},
          {Kind::Mapping},  {Kind::Fence},         {Kind::Command, 4}};
}

/// Programs and what else a device keeps are made again for each of these faults.
bool needsNewDevice(const Fails& fails) { return fails.kind == faults::Kind::Program; }

/// Calls run() with a fault. If it has happened, calls next(), which finds errors that the driver still has to report. Returns whether
/// it has happened.
template <class Run, class Next>
bool withFault(const Fails& fails, long number, Run&& run, Next&& next) {
  if (!fails.kind) {
    const faults::MpiFault fault(number);
    run();
    return faults::MpiFault::hasFired();
  }
  const faults::Fault fault(*fails.kind, number);
  run();
  if (fault.hasFired()) next();
  return fault.hasFired();
}

/// Runs the program with one fault on a rank. Returns whether it has happened.
bool runWithFault(Place& place, const Program& program, const Fails& fails, int victim, long number,
                  const Result& expected, Counts& counts) {
  std::snprintf(now.data(), now.size(), "%s, %s %ld of rank %d", program.name, fails.name().c_str(), number,
                victim);
  place.reset();
  const faults::Handles before = faults::handles();
  std::string error, later;
  // What a program calls next, be it in a handler: whoever has not thrown hears of another rank's error now, or its own driver's.
  const auto next = [&] { return errorOf([&] { (void)sum(place.healthy); }); };
  bool hasCalledNext = false;
  const auto callNext = [&] {
    if (error.empty() && !std::exchange(hasCalledNext, true)) later = next();
  };
  const auto run = [&] { error = errorOf([&] { program.run(place); }); };
  const bool hasFiredHere = rank == victim && withFault(fails, number, run, callNext);
  if (rank != victim) run();
  callNext();
  if (!error.empty() || !later.empty()) {
    const std::string twice = next();
    if (!twice.empty()) fail("after '" + error + later + "' the next call fails, too: " + twice);
  }
  const bool hasFired = countOf(hasFiredHere) > 0;
  const int thrown = countOf(!error.empty()), heard = countOf(!later.empty());
  if (thrown + heard > 0 && !hasFired) fail("an error without a fault: " + error + later);
  if (hasFired) ++counts.faults;
  if (thrown + heard == 0) {
    if (resultOf(place, program) != expected) fail("a wrong result without an error");
    if (hasFired) ++counts.harmless;
  } else if (countOf(error.find("there is no host memory for 1 element") != std::string::npos) > 0) {
    ++counts
          .harmless;  // sk::Future::get() makes room for its elements before it asks the ranks, and can be called again
  } else if (thrown + heard != ranks) {
    fail("not all ranks hear of an error: " + error);
  } else if (heard == 0) {
    ++counts.together;
  } else {
    ++counts.atNext;
  }
  const auto again = errorOf([&] {
    place.reset();
    program.run(place);
  });
  if (!again.empty()) fail("after '" + error + "' it does not run again: " + again);
  if (resultOf(place, program) != expected) fail("after '" + error + "' the result is wrong");
  faults::Handles after = faults::handles();
  after.communicators = before.communicators;  // those of lines of ranks are kept
  if (after != before)
    fail("requests, files or datatypes are left: " + std::to_string(after.requests) + ", " +
         std::to_string(after.files) + ", " + std::to_string(after.types));
  return hasFired;
}

void tryAll(const std::string& folder, const Program& program) {
  std::snprintf(now.data(), now.size(), "%s", program.name);
  std::optional<Place> place(folder);
  place->reset();
  program.run(*place);
  const Result expected = resultOf(*place, program);
  const auto handles = faults::handles();
  for (const Fails& fails : failing(place->domain.device().kind() == "native")) {
    Counts counts;
    for (const int victim : {0, ranks - 1}) {
      for (long number = 1;; number += number > 15 ? fails.step : 1) {
        if (needsNewDevice(fails) || program.isFirst) {
          place.reset();
          place.emplace(folder);
        }
        if (!runWithFault(*place, program, fails, victim, number, expected, counts)) break;
      }
    }
    if (faults::handles().communicators != handles.communicators) fail("communicators are left");
    if (rank == 0) {
      std::printf(
          "%-20s %-10s %4ld faults: %ld harmless, %ld thrown by all ranks in the program, %ld heard of after "
          "it\n",
          program.name, fails.name().c_str(), counts.faults, counts.harmless, counts.together, counts.atNext);
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  std::signal(SIGALRM, giveUp);
  alarm(280);
  long number = ::getpid();
  MPI_Bcast(&number, 1, MPI_LONG, 0, MPI_COMM_WORLD);
  const auto folder = std::filesystem::temp_directory_path() / ("sk_rank_faults_" + std::to_string(number));
  if (rank == 0) std::filesystem::create_directories(folder);
  MPI_Barrier(MPI_COMM_WORLD);
  faults::install();
  for (const Program& program : programs()) {
    const auto isNamed = [&](const char* part) { return std::strstr(program.name, part) != nullptr; };
    if (argc > 1 && std::none_of(argv + 1, argv + argc, isNamed)) continue;
    tryAll(folder.string(), program);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0) std::filesystem::remove_all(folder);
  if (faults::handles() != faults::Handles{}) fail("handles are left at the end");
  const faults::LiveObjects objects = faults::liveObjects();
  if (objects != faults::LiveObjects{}) fail("GL objects are left at the end: " + objects.kinds);
  MPI_Finalize();
  return 0;
}
