// SPDX-License-Identifier: MIT
//
// sk_bench: is what skc and the runtime make as fast as what one would write by hand? Prints a table with
// the bars that must hold; --check makes a missed bar the exit status.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <sk/sk.hpp>

#include "bench.sk.hpp"
#include "compile_time.hpp"
#include "contraction.hpp"
#include "functions.hpp"
#include "hand_written.hpp"
#include "loop_cost.hpp"
#include "report.hpp"
#include "rounds.hpp"
#include "side_by_side.hpp"
#include "view_cost.hpp"

namespace {

struct Settings {
  std::string device = "gl";
  int rounds = 21;
  double sampleMilliseconds = 30.0;
  std::filesystem::path skc = SK_BENCH_SKC;
  std::filesystem::path sources = SK_BENCH_SOURCES;
  std::vector<std::string> compiler = {SK_BENCH_CXX, "-std=c++20", "-O2", "-I" SK_BENCH_INCLUDE};
  std::filesystem::path json;
  bool check = false;
  bool withoutCompiler = false;
  bool onlyContraction = false;
};

/// What the host spends on a call that the device has next to nothing to do for. Waiting is left out.
void hostCost(sk::Device& device, const Settings& settings, bench::Report& report) {
  constexpr int calls = 1000;
  const std::vector<float> values = bench::ramp(64, 0.37f);
  auto x = device.stream<float>({8, 8}), y = device.stream<float>({8, 8}), r = device.stream<float>({8, 8});
  x.write(values);
  y.write(values);
  bench::saxpy(2.5f, x, y, r);
  std::vector<double> microseconds;
  for (int round = 0; round < settings.rounds; ++round) {
    device.finish();
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) bench::saxpy(static_cast<float>(i), x, y, r);
    microseconds.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count() / calls);
  }
  device.finish();
  report.add({"a queued call of 8 x 8 elements, host", "us", bench::quartilesOf(microseconds), 2.0, {}});
}

void sumTime(sk::Device& device, const Settings& settings, bench::Report& report) {
  constexpr int side = 2048;
  auto x = device.stream<float>({side, side});
  x.write(bench::ramp(std::int64_t{side} * side, 0.37f));
  const auto work = [&](int times) {
    for (int i = 0; i < times; ++i) bench::sum(x);
  };
  const bench::Quartiles time = bench::measure(work, settings.rounds, settings.sampleMilliseconds);
  report.add({"sum of 2^22 floats to a value",
              "ms",
              time,
              {},
              fmt::format("{:.3g} GB/s", 4.0 * side * side / (time.median * 1e6))});
}

/// Natively, drawn, and dispatched where the device can.
void viewCosts(sk::Device& device, const Settings& settings, bench::Report& report) {
  const auto on = [&](sk::Device& where, std::string_view name, sk::Target target) {
    bench::viewCosts(where, name, target, settings.rounds, settings.sampleMilliseconds, report);
  };
  sk::Device native = sk::Device::native();
  on(native, "native", sk::Target::Default);
  on(device, "fragment", sk::Target::Fragment);
  try {
    on(device, "compute", sk::Target::Compute);
  } catch (const sk::Error&) {  // a device without compute programs
  }
}

void compileTimes(const Settings& settings, bench::Report& report) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("sk_bench.{}", getpid());
  struct File {
    const char* name;
    std::optional<double> bar;
  };
  for (const auto& [name, bar] :
       {File{"applications/saxpy/saxpy.sk", 120.0}, File{"applications/stats/stats.sk", {}},
        File{"classics/reaction/reaction.sk", {}}, File{"applications/edges/edges.sk", {}},
        File{"applications/cloth/cloth.sk", 3000.0}}) {
    const std::filesystem::path file = settings.sources / name;
    report.add({fmt::format("skc {}", file.filename().string()),
                "ms",
                bench::compileTime(settings.skc, file, folder, std::min(settings.rounds, 9)),
                bar,
                {}});
  }
  report.add({"from a kernel and a sum to objects: skc, and C++",
              "ms",
              bench::editTime(settings.skc, settings.compiler, SK_BENCH_SMALL, folder,
                              std::min(settings.rounds, 10)),
              1000.0,
              {}});
  std::filesystem::remove_all(folder);
}

void measureMost(const Settings& settings, bench::Report& report) {
  sk::Device device(settings.device);
  const bench::PlainContext context(device.name());
  bench::SideBySide sideBySide(device, context, {settings.rounds, settings.sampleMilliseconds}, report);
  sideBySide.control(2048);
  for (const int size : {1024, 2048}) sideBySide.saxpy(size);
  for (const int size : {1024, 2048}) sideBySide.binomial(size);
  bench::functions(device, settings.rounds, settings.sampleMilliseconds, report);
  hostCost(device, settings, report);
  bench::loopCosts(device, settings.rounds, report);
  sumTime(device, settings, report);
  viewCosts(device, settings, report);
  bench::warmStart(settings.device, std::min(settings.rounds, 9), report);
  if (!settings.withoutCompiler) compileTimes(settings, report);
}

int measureAll(const Settings& settings) {
  bench::Report report(sk::Device(settings.onlyContraction ? "software" : settings.device).name());
  if (settings.onlyContraction)
    bench::contractions(settings.rounds, settings.sampleMilliseconds, report);
  else
    measureMost(settings, report);
  fmt::print("\n{}\n", report.allPassed() ? "every bar holds" : "a bar is missed");
  if (!settings.json.empty()) {
    std::ofstream file(settings.json);
    file << report.json().dump(2) << "\n";
    if (!file.flush()) throw std::runtime_error(fmt::format("cannot write '{}'", settings.json.string()));
  }
  return settings.check && !report.allPassed() ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  Settings s;
  CLI::App cli(
      "Measures generated kernels against hand-written GLSL, accurate intrinsics against the device's own, "
      "the cost "
      "of a call, and skc's speed.",
      "sk_bench");
  cli.add_option("--device", s.device, "where to run: a device with GL (default: the best)");
  cli.add_option("--rounds", s.rounds, "rounds in which contenders take turns (default: 21)")
      ->check(CLI::Range(1, 10'000));
  cli.add_option("--sample", s.sampleMilliseconds, "milliseconds of a contender in each round (default: 30)")
      ->check(CLI::Range(0.1, 1e5));
  cli.add_option("--json", s.json, "write the results to this file as well");
  cli.add_option("--skc", s.skc, "the compiler (default: this build's)");
  cli.add_option("--sources", s.sources, "folder of the examples, whose .sk files are compiled");
  cli.add_flag("--without-compiler", s.withoutCompiler, "leave out how long compilers take");
  cli.add_flag("--check", s.check, "exit status 1 where a bar is missed");
  cli.add_flag("--contraction", s.onlyContraction,
               "measure what Contraction::Exact costs on the software renderer, and nothing else");
  CLI11_PARSE(cli, argc, argv);
  try {
    return measureAll(s);
  } catch (const std::exception& error) {
    fmt::print(stderr, "sk_bench: {}\n", error.what());
    return 1;
  }
}
