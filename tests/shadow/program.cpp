// SPDX-License-Identifier: MIT
//
// Programs for the tests of shadows, by name: those with one bad kernel, one that makes calls of every kind and prints all
// results, one that computes the own errors of its calls itself, and those that end in odd ways.
#include <sk/algorithm.hpp>
#include <sk/sk.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "everything.sk.hpp"
#include "faults.sk.hpp"
#include "precise.sk.hpp"

namespace {

constexpr int size = 1000;

using Field = sk::Stream<float>;

struct Plate {
  sk::Device device;
  Field u = device.stream<float>({size}, sk::Storage::Default, "u");
  Field v = device.stream<float>({size}, sk::Storage::Default, "v");
  Field w = device.stream<float>({size}, sk::Storage::Default, "w");

  explicit Plate(float low = 0.5F, float high = 1.5F) { faults::ramp(low, high, u); }

  /// Healthy kernels before and after what makes v of u.
  template <class Fault>
  void around(Fault&& fault) {
    faults::gain(1.25F, u, w);
    faults::smooth(w, u);
    fault();
    faults::smooth(v, w);
    faults::gain(0.75F, w, u);
    std::printf("%a\n", static_cast<double>(faults::total(u)));
    u.read();
  }
};

void runHalf() {
  Plate plate;
  plate.around([&] { faults::advance.with({.precision = sk::Precision::Half})(0.01F, plate.u, plate.v); });
}

void runStored() {
  Plate plate;
  plate.v = plate.device.stream<float>({size}, sk::Storage::Half, "v");
  plate.around([&] { faults::advance(0.01F, plate.u, plate.v); });
}

/// Doubles that floats store, over and over again.
void runWidened() {
  Plate plate;
  for (int i = 0; i < 1000; ++i) {
    faults::advance.with({.precision = sk::Precision::Double})(0.001F, plate.u, plate.v);
    std::swap(plate.u, plate.v);
  }
  plate.u.read();
}

void runNan() {
  Plate plate;
  for (int i = 0; i < 1200; ++i) {
    faults::root(999.5F, static_cast<float>(i), plate.u, plate.v);
    faults::smooth(plate.v, plate.w);
    faults::gain(0.01F, plate.w, plate.u);
  }
  plate.u.read();
}

void runFloatNan() {
  Plate plate(0.1F, 9);
  plate.around([&] { faults::angle(plate.u, plate.v); });
}

/// A wrong input that hardly counts in the result, in a call of a loop.
void runMixed() {
  Plate plate;
  faults::advance.with({.precision = sk::Precision::Half})(0.01F, plate.u, plate.v);
  faults::spread(plate.u, plate.w);
  for (int i = 0; i < 10; ++i) {
    faults::mix(1e-9F, plate.v, plate.w, plate.u);
    std::swap(plate.u, plate.v);
  }
  plate.v.read();
}

/// The host copies into halves.
void runNarrowed() {
  Plate plate;
  faults::gain(1.25F, plate.u, plate.v);
  auto halves = plate.device.stream<float>({size}, sk::Storage::Half, "halves");
  plate.v.copyTo(halves);
  halves.read();
}

/// The worst of several reads of one stream is not the last.
void runLate() {
  Plate plate;
  faults::spread(plate.u, plate.v);
  plate.v.read();
  faults::gain(1.25F, plate.u, plate.v);
  plate.v.read();
}

void runInfinity() {
  Plate plate(1e18F, 3e19F);
  plate.around([&] { faults::square(plate.u, plate.v); });
}

void runFlush() {
  Plate plate;
  plate.around([&] { faults::vanish(plate.u, plate.v); });
}

/// The cube, in floats, of an element near the middle that rounding makes larger.
float limitIn(const Field& field) {
  const std::vector<float> values = field.read();
  for (std::size_t i = values.size() / 2; i < values.size(); ++i) {
    volatile float square = values[i] * values[i], cube = square * values[i];
    const double x = values[i];
    if (static_cast<double>(cube) > x * x * x) return cube;
  }
  return 0;
}

void runFlip() {
  Plate plate;
  plate.around([&] { faults::flip(limitIn(plate.u), plate.u, plate.v); });
}

void runCell() {
  Plate plate;
  auto cells = plate.device.stream<int>({size});
  faults::gain(1, plate.u, plate.w);
  faults::cell(limitIn(plate.w), plate.w, cells);
  faults::count(cells, plate.v);
  plate.v.read();
}

void runTable() {
  Plate plate(-3, 3);
  plate.around([&] { faults::response(plate.u, plate.v); });
}

void runCancel() {
  Plate plate;
  plate.around([&] { faults::spread(plate.u, plate.v); });
}

void runUnstable() {
  Plate plate;
  for (int i = 0; i < 40; ++i) {
    faults::diffuse(0.6F, plate.u, plate.v);
    faults::gain(1, plate.v, plate.w);
    std::swap(plate.u, plate.w);
  }
  plate.u.read();
}

/// The same, with kernels that look at each step.
void runWatched() {
  Plate plate;
  Field squares = plate.device.stream<float>({size});
  for (int i = 0; i < 40; ++i) {
    faults::diffuse(0.6F, plate.u, plate.v);
    faults::square(plate.v, squares);
    faults::cube(plate.v, squares);
    std::printf("%a\n", static_cast<double>(faults::total(squares)));
    std::swap(plate.u, plate.v);
  }
  plate.u.read();
}

/// With every=2, the bad call is not compared.
void runUnseen() {
  Plate plate;
  faults::gain(1.25F, plate.u, plate.w);
  std::printf("%a\n", static_cast<double>(faults::total(plate.w)));
  faults::advance(0.01F, plate.w, plate.v);
  faults::advance.with({.precision = sk::Precision::Half})(0.01F, plate.w, plate.v);
  std::printf("%a\n", static_cast<double>(faults::total(plate.v)));
  faults::smooth(plate.v, plate.u);
  plate.u.read();
}

/// A wrong input that hardly counts in the result; `isSteep`: and what magnifies the error of the result.
void hide(bool isSteep) {
  Plate plate;
  faults::spread(plate.u, plate.w);
  faults::offset(1e-9F, plate.u, plate.w, plate.v);
  if (isSteep) faults::slope(plate.v, plate.w);
  (isSteep ? plate.w : plate.v).read();
}

void runHidden() { hide(false); }
void runSteep() { hide(true); }

/// All calls of one kernel are bad, and few of them are compared.
void runSteady() {
  Plate plate;
  for (int i = 0; i < 15; ++i) {
    faults::advance.with({.precision = sk::Precision::Half})(0.01F, plate.u, plate.v);
    faults::gain(1, plate.v, plate.w);
    std::swap(plate.u, plate.w);
  }
  plate.u.read();
}

/// Keys that are different doubles and few different floats, in the other order.
struct Keys : Plate {
  Keys() : Plate(0.50000006F, 0.5F) { faults::ramp(1, 1000, w); }
};

void runSorted() {
  Keys plate;
  sk::sort(plate.u, plate.w);
  plate.w.read();
}

void runOrdered() {
  Keys plate;
  std::printf("%d\n", sk::order(plate.u).read()[0]);
}

void runUnique() {
  Keys plate;
  std::printf("%lld\n", static_cast<long long>(sk::unique(plate.u, plate.w)));
}

void runNearest() {
  Plate plate(0.299F, 0.301F);
  auto measured = plate.device.stream<faults::Nearest>({size});
  auto best = plate.device.stream<faults::Nearest>({1});
  faults::gain(1, plate.u, plate.w);
  faults::gain(1, plate.u, plate.v);
  faults::measure(plate.u, measured);
  faults::nearest(measured, best);
  std::printf("%d\n", best.read()[0].id);
}

void runSum() {
  sk::Device device;
  auto values = device.stream<float>({1 << 20}, sk::Storage::Default, "values");
  std::vector<float> numbers(values.size());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < numbers.size(); ++i) {
    numbers[i] = static_cast<float>(i * 7919 % 1000003) * (i % 2 == 0 ? 1.234F : -1.234F);
    sum += numbers[i];
  }
  numbers.back() = static_cast<float>(1 - sum);
  values.write(numbers);
  for (int count = 1 << 19; count >= 1; count /= 2) {
    Field sums = device.stream<float>({count});
    faults::pairs(values, sums);
    values = std::move(sums);
  }
  std::printf("%a\n", static_cast<double>(values.read()[0]));
}

void runPush() {
  Plate plate;
  Field kept = plate.device.stream<float>({size});
  faults::keep(limitIn(plate.u), plate.u, kept);
  std::printf("%zu\n", kept.read().size());
}

/// The host asks for the number alone.
void runCounted() {
  Plate plate;
  Field kept = plate.device.stream<float>({size});
  faults::keep(limitIn(plate.u), plate.u, kept);
  std::printf("%lld\n", static_cast<long long>(kept.size()));
}

void print(const char* name, const std::vector<float>& values) {
  std::printf("%s", name);
  for (const float value : values) std::printf(" %a", static_cast<double>(value));
  std::printf("\n");
}

void runEverything() {
  namespace e = everything;
  sk::Device device;
  auto particles = device.stream<e::Particle>({97});
  auto weight = device.stream<float>({97}), x = device.stream<float>({97}), kept = device.stream<float>({97});
  auto cell = device.stream<int>({97});
  auto histogram = device.stream<float>({9});
  e::start({0.3F, 0.7F}, particles, weight);
  e::split(particles, x, cell);
  histogram.fill(0);
  e::spread(cell, weight, histogram);
  print("histogram", histogram.read());
  e::positive(x, kept);
  print("kept", kept.read());
  sk::sort(x, cell);
  print("sorted", x.read());
  for (const int c : cell.read()) std::printf(" %d", c);
  e::prefix(x, x);
  print("\nprefix", x.read());

  auto u = device.stream<float>({20, 31}), v = device.stream<float>({20, 31}),
       d = device.stream<float>({20, 31});
  std::vector<float> first(u.size());
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = std::sin(0.1F * static_cast<float>(i * i % 97));
  u.write(first);
  auto largest = device.scalar<float>();
  auto done = device.scalar<bool>();
  sk::Loop loop = device.record([&] {
    e::relax(u, 0.2F, v);
    e::change(v, u, d, largest);
    done = largest < 0.05F;
    std::swap(u, v);
  });
  std::printf("steps %lld\n", static_cast<long long>(loop.until(done, {.every = 4, .most = 100})));
  print("relaxed", u.read());
  e::relax(u.domain({2, 3}, {12, 20}), 0.1F, v.domain({5, 5}, {15, 22}));
  e::relax.with({.box = {{1, 1}, {4, 9}}})(u, 0.2F, d);
  v.domain({0, 0}, {1, 31}).copyTo(d.domain({19, 0}, {20, 31}));
  print("views", d.read());
  auto twice = largest * 2.F + 1.F;
  std::printf("scalar %a\n", static_cast<double>(twice.read()));
  auto byte = device.stream<sk::unorm8>({97});
  auto half = device.stream<sk::half>({97});
  e::narrow(x, byte, half);
  std::printf("narrow");
  for (const sk::half h : half.read()) std::printf(" %a", static_cast<double>(static_cast<float>(h)));
  std::vector<int> starts{0, 3, 3, 40, 97};
  auto from = device.stream<int>({5});
  from.write(starts);
  const sk::Rows rows(from);
  auto sums = device.stream<float>({4});
  e::sum(rows(weight), sums);
  print("\nrows", sums.read());
  std::printf("sum %a\n", static_cast<double>(e::sum.with({.accumulate = sk::Accumulate::Exact})(weight)));
}

/// Advances u to v, and prints the own error of the call, relative to the norm of the exact results.
void advanceAndPrint(const Field& u, Field& v) {
  const std::vector<float> before = u.read();
  faults::advance(0.01F, u, v);
  const std::vector<float> after = v.read();
  double squares = 0, norm = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const double x = before[k], exact = x + static_cast<double>(0.01F) * (x * (1 - x));
    squares += (after[k] - exact) * (after[k] - exact);
    norm += exact * exact;
  }
  std::printf("%.12g\n", std::sqrt(squares / norm));
}

void runReplay() {
  sk::Device device;
  Field u = device.stream<float>({size}, sk::Storage::Default, "u"),
        v = device.stream<float>({size}, sk::Storage::Default, "v");
  faults::ramp(0.1F, 0.9F, u);
  for (int i = 0; i < 20; ++i) {
    advanceAndPrint(u, v);
    std::swap(u, v);
  }
}

/// The same after each way in which elements change: the reference must compute with those that the device has now.
void runChanges() {
  sk::Device device;
  Field u = device.stream<float>({size}), v = device.stream<float>({size}), w = device.stream<float>({size});
  auto key = device.stream<float>({size});
  const auto advanceTwice = [&] {
    advanceAndPrint(u, v);
    advanceAndPrint(v, u);  // in whose error the first call's is
  };
  faults::ramp(0.1F, 0.9F, u);
  advanceTwice();
  std::vector<float> numbers(size);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = 0.2F + 0.0007F * static_cast<float>(i * 37 % size);
  u.write(numbers);
  advanceTwice();
  u.domain({100}, {300}).write(std::vector<float>(200, 0.7F));
  advanceTwice();
  v.fill(0.4F);
  v.domain({7}, {size}).copyTo(u.domain({0}, {size - 7}));
  advanceTwice();
  faults::gain.with({.box = {{250}, {750}}})(0.3F, v, u);
  advanceTwice();
  faults::gain(0.3F, v.domain({0}, {400}), u.domain({500}, {900}));
  advanceTwice();
  faults::smooth(u, u);
  advanceTwice();
  faults::ramp(1, 0.1F, key);
  sk::sort(key, u);
  advanceTwice();
  v.copyTo(w);
  std::swap(u, w);
  advanceTwice();
  sk::Loop loop = device.record([&] { faults::gain(0.5F, u, u); });
  loop.repeat(3);
  advanceTwice();
}

/// One element is inexact, far inside of a long stream, which several threads compare.
void runWorst() {
  sk::Device device;
  auto x = device.stream<float>({600, 1000}), r = device.stream<float>({600, 1000});
  std::vector<float> numbers(x.size(), 1.5F);
  numbers[456789] = 1.1F;
  x.write(numbers);
  faults::square(x, r);
  r.read();
}

/// The most memory that this process has had, in bytes.
std::int64_t peakMemory() {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("VmHWM:")) return 1024 * std::atoll(line.c_str() + 6);
  }
  return 0;
}

/// Calls on many streams of different sizes. Prints the bytes of all streams in doubles, of the largest one, and of the process.
void runMemory() {
  sk::Device device;
  std::vector<Field> streams;
  std::int64_t all = 0, largest = 0;
  for (int i = 0; i < 8; ++i) {
    const std::int64_t count = (1 << 20) + 1000 * i;
    for (int k = 0; k < 2; ++k) streams.push_back(device.stream<float>({count}));
    all += 2 * 8 * count;
    largest = 8 * count;
  }
  for (std::size_t i = 0; i < streams.size(); i += 2) faults::ramp(0.1F, 0.9F, streams[i]);
  for (int round = 0; round < 4; ++round) {
    for (std::size_t i = 0; i < streams.size(); i += 2) {
      faults::advance(0.01F, streams[i], streams[i + 1]);
      std::swap(streams[i], streams[i + 1]);
    }
  }
  std::printf("%lld %lld %lld\n", static_cast<long long>(all), static_cast<long long>(largest),
              static_cast<long long>(peakMemory()));
}

#if defined(__SIZEOF_FLOAT128__)
using Quad = __float128;
#else
using Quad = long double;  // of 128 bits there
#endif

/// Prints the own error of a call in doubles, found with numbers that have twice as many digits. It is relative to the results of
/// the reference, which are the device's.
void runPrecise() {
  sk::Device device;
  auto x = device.stream<double>({size}), r = device.stream<double>({size});
  std::vector<double> numbers(size);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = 0.001 * static_cast<double>(i * i % 997);
  x.write(numbers);
  precise::spread(x, r);
  const std::vector<double> after = r.read();
  double squares = 0, norm = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Quad m = static_cast<Quad>(numbers[i]) + 1000000000, half = 0.5;
    const auto exact = static_cast<double>(m * m - (m - half) * (m + half));
    squares += (after[i] - exact) * (after[i] - exact);
    norm += after[i] * after[i];
  }
  std::printf("%.12g\n", std::sqrt(squares / norm));
}

void runFine() {
  Plate plate;
  plate.around([&] { faults::advance(0.01F, plate.u, plate.v); });
}

void runExit() {
  static Plate* plate = new Plate;
  plate->around([&] { faults::advance(0.01F, plate->u, plate->v); });
  std::exit(3);
}

void runAbort() {
  Plate plate;
  plate.around([&] { faults::advance(0.01F, plate.u, plate.v); });
  std::abort();
}

/// Nothing catches this.
void runThrow() {
  Plate plate;
  plate.around([&] { faults::advance(0.01F, plate.u, plate.v); });
  throw 3;
}

void runChdir() {
  Plate plate;
  plate.around([&] { faults::advance(0.01F, plate.u, plate.v); });
  if (chdir("/") != 0) std::abort();
}

/// Numbers that are no floats.
void runWide() {
  sk::Device device;
  Field u = device.stream<float>({size}, sk::Storage::Extended, "u"),
        v = device.stream<float>({size}, sk::Storage::Extended, "v");
  std::vector<double> numbers(size);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = 0.1 + static_cast<double>(i) / 3000;
  u.writeReals(numbers);
  faults::gain.with({.precision = sk::Precision::Extended})(1, u, v);
  for (const double value : v.readReals()) std::printf("%a\n", value);
}

void runFork() {
  Plate plate;
  faults::advance(0.01F, plate.u, plate.v);
  if (fork() == 0) {
    faults::advance(0.01F, plate.v, plate.u);
    std::printf("%a\n", static_cast<double>(faults::total(plate.u)));
    std::exit(0);
  }
  int status = 0;
  wait(&status);
  std::printf("%d\n", status);
  plate.v.read();
}

/// Writes to the report's own file.
void runWrite() {
  Plate plate;
  faults::advance(0.01F, plate.u, plate.v);
  std::ofstream("report.html") << "the program's own\n";
  plate.v.read();
}

/// Waits between two calls.
void runWait() {
  Plate plate;
  faults::advance(0.01F, plate.u, plate.v);
  std::puts("waits");
  std::fflush(stdout);
  std::getchar();
  faults::advance(0.01F, plate.v, plate.u);
  plate.u.read();
}

void runNothing() {
  sk::Device device;
  std::printf("%d\n", device.stream<float>({4}).shape().rank());
}

void runDevices() {
  Plate first;
  first.around([&] { faults::advance(0.01F, first.u, first.v); });
  Plate second(1e18F, 3e19F);
  second.around([&] { faults::square(second.u, second.v); });
}

const std::map<std::string, std::function<void()>> programs = {
    {"half", runHalf},         {"stored", runStored},     {"nan", runNan},
    {"floatnan", runFloatNan}, {"infinity", runInfinity}, {"flush", runFlush},
    {"flip", runFlip},         {"cell", runCell},         {"table", runTable},
    {"cancel", runCancel},     {"unstable", runUnstable}, {"nearest", runNearest},
    {"sum", runSum},           {"push", runPush},         {"everything", runEverything},
    {"replay", runReplay},     {"fine", runFine},         {"exit", runExit},
    {"abort", runAbort},       {"fork", runFork},         {"overwrite", runWrite},
    {"nothing", runNothing},   {"devices", runDevices},   {"changes", runChanges},
    {"memory", runMemory},     {"mixed", runMixed},       {"late", runLate},
    {"narrowed", runNarrowed}, {"precise", runPrecise},   {"worst", runWorst},
    {"widened", runWidened},   {"watched", runWatched},   {"unseen", runUnseen},
    {"steady", runSteady},     {"sorted", runSorted},     {"ordered", runOrdered},
    {"unique", runUnique},     {"counted", runCounted},   {"throw", runThrow},
    {"chdir", runChdir},       {"wide", runWide},         {"wait", runWait},
    {"hidden", runHidden},     {"steep", runSteep}};

}  // namespace

int main(int argc, char** argv) {
  const auto found = programs.find(argc > 1 ? argv[1] : "");
  if (found == programs.end()) return 2;
  try {
    found->second();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
