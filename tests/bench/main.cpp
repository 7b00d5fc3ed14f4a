// SPDX-License-Identifier: MIT
//
// sk_bench: is what skc and the runtime make as fast as what one would write by hand? Prints a table with
// the bars that must hold; --check makes a missed bar the exit status.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <sk/sk.hpp>

#include "bench.sk.hpp"
#include "compile_time.hpp"
#include "hand_written.hpp"
#include "rounds.hpp"

namespace {

struct Settings {
  std::string device;
  int rounds = 21;
  double sampleMilliseconds = 30.0;
  std::filesystem::path skc = SK_BENCH_SKC;
  std::filesystem::path sources = SK_BENCH_SOURCES;
  std::filesystem::path json;
  bool check = false;
};

/// One line of the table. Values, bars and quartiles have the unit's dimension; smaller is better.
struct Result {
  std::string name;
  std::string unit;
  bench::Quartiles value;
  std::optional<double> bar;
  std::string note;
  bool passed() const { return !bar || value.median <= *bar; }
};

class Report {
 public:
  explicit Report(const std::string& device) : device_(device) {
    fmt::print("{}\n\n{:<44} {:>9}  {:^17}  {:>9}\n{:-<96}\n", device, "what", "median", "quartiles", "bar",
               "");
  }

  void add(Result result) {
    const auto digits = [&](double x) { return fmt::format("{:.3g}", x); };
    fmt::print("{:<44} {:>9}  {:>8} {:>8}  {:>9}  {}\n", result.name,
               digits(result.value.median) + " " + result.unit, digits(result.value.low),
               digits(result.value.high), result.bar ? digits(*result.bar) + " " + result.unit : "",
               result.bar ? (result.passed() ? "ok" : "MISSED") : "");
    if (!result.note.empty()) fmt::print("    {}\n", result.note);
    results_.push_back(std::move(result));
  }

  bool allPassed() const {
    for (const Result& r : results_) {
      if (!r.passed()) return false;
    }
    return true;
  }

  nlohmann::json json() const {
    nlohmann::json rows = nlohmann::json::array();
    for (const Result& r : results_) {
      nlohmann::json row = {{"name", r.name},     {"unit", r.unit},       {"median", r.value.median},
                            {"low", r.value.low}, {"high", r.value.high}, {"passed", r.passed()}};
      if (r.bar) row["bar"] = *r.bar;
      rows.push_back(std::move(row));
    }
    return {{"device", device_}, {"results", std::move(rows)}};
  }

 private:
  std::string device_;
  std::vector<Result> results_;
};

std::vector<float> ramp(std::int64_t size, float step) {
  std::vector<float> values;
  for (std::int64_t i = 0; i < size; ++i) values.push_back(std::fmod(static_cast<float>(i) * step, 1.0f));
  return values;
}

bench::Contender handWritten(const bench::PlainContext& context, const bench::PlainPass& pass) {
  return [&](int times) {
    const bench::PlainContext::Current current(context);
    for (int i = 0; i < times; ++i) pass.draw();
    glFinish();
  };
}

/// One kernel against GLSL written by hand, which must also agree in every bit.
class SideBySide {
 public:
  SideBySide(sk::Device& device, const bench::PlainContext& context, const Settings& settings, Report& report)
      : device_(device), context_(context), settings_(settings), report_(report) {}

  void saxpy(int size) {
    const std::vector<float> hostX = ramp(std::int64_t{size} * size, 0.37f),
                             hostY = ramp(std::int64_t{size} * size, 0.11f);
    auto x = stream(size, hostX), y = stream(size, hostY), r = stream(size, hostX);
    const auto ours = [&](int times) {
      for (int i = 0; i < times; ++i) bench::saxpy(2.5f, x, y, r);
      device_.finish();
    };
    const std::string name = fmt::format("saxpy {0} x {0}", size);
    against(name + " over hand-written", 1.05, ours, r, bench::saxpyText, size, {hostX, hostY}, 2.5f);
    against(name + " over one by samplers", {}, ours, r, bench::saxpySampledText, size, {hostX, hostY}, 2.5f);
  }

  /// One program against itself: how far from 1 this machine puts a ratio for no reason.
  void control(int size) {
    const std::vector<float> hostX = ramp(std::int64_t{size} * size, 0.37f);
    std::optional<bench::PlainPass> a, b;
    {
      const bench::PlainContext::Current current(context_);
      a.emplace(bench::binomialText, size, size, std::vector<std::vector<float>>{hostX});
      b.emplace(bench::binomialText, size, size, std::vector<std::vector<float>>{hostX});
    }
    const bench::Comparison c = bench::compare(handWritten(context_, *a), handWritten(context_, *b),
                                               settings_.rounds, settings_.sampleMilliseconds);
    report_.add({fmt::format("3 x 3 stencil {0} x {0} by hand over itself", size), "x", c.ratio, {}, {}});
    const bench::PlainContext::Current current(context_);
    a.reset();
    b.reset();
  }

  void binomial(int size) {
    const std::vector<float> hostX = ramp(std::int64_t{size} * size, 0.37f);
    auto x = stream(size, hostX), r = stream(size, hostX);
    const auto ours = [&](int times) {
      for (int i = 0; i < times; ++i) bench::binomial(x, r);
      device_.finish();
    };
    const std::string name = fmt::format("3 x 3 stencil {0} x {0}", size);
    against(name + " over hand-written", 1.05, ours, r, bench::binomialText, size, {hostX}, {});
    against(name + " over one by samplers", {}, ours, r, bench::binomialSampledText, size, {hostX}, {});
  }

 private:
  sk::Stream<float> stream(int size, const std::vector<float>& values) {
    auto s = device_.stream<float>({size, size});
    s.write(values);
    return s;
  }

  void against(const std::string& name, std::optional<double> bar, const bench::Contender& ours,
               const sk::Stream<float>& oursResult, const char* text, int size,
               const std::vector<std::vector<float>>& inputs, std::optional<float> a) {
    std::optional<bench::PlainPass> pass;
    {
      const bench::PlainContext::Current current(context_);
      pass.emplace(text, size, size, inputs);
      if (a) pass->setFloat("a", *a);
    }
    const bench::Comparison c =
        bench::compare(ours, handWritten(context_, *pass), settings_.rounds, settings_.sampleMilliseconds);
    std::vector<float> theirs;
    {
      const bench::PlainContext::Current current(context_);
      theirs = pass->result();
      pass.reset();
    }
    report_.add({name, "x", c.ratio, bar,
                 fmt::format("{:.3g} ms against {:.3g} ms; {}", c.ours.median, c.theirs.median,
                             oursResult.read() == theirs ? "equal in every bit" : "the results DIFFER")});
  }

  sk::Device& device_;
  const bench::PlainContext& context_;
  const Settings& settings_;
  Report& report_;
};

/// What the host spends on a call that the device has next to nothing to do for. Waiting is left out.
void hostCost(sk::Device& device, const Settings& settings, Report& report) {
  constexpr int calls = 1000;
  const std::vector<float> values = ramp(64, 0.37f);
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
  report.add({"a queued call of 8 x 8 elements, host", "us", bench::quartilesOf(microseconds), 5.0, {}});
}

void sumTime(sk::Device& device, const Settings& settings, Report& report) {
  constexpr int side = 2048;
  auto x = device.stream<float>({side, side});
  x.write(ramp(std::int64_t{side} * side, 0.37f));
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

void compileTimes(const Settings& settings, Report& report) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("sk_bench.{}", getpid());
  for (const char* name : {"saxpy", "stats", "gray_scott", "edges"}) {
    const std::filesystem::path file = settings.sources / name / (std::string(name) + ".sk");
    report.add(
        {fmt::format("skc {}.sk", name), "ms", bench::compileTime(settings.skc, file, folder, 20), 60.0, {}});
  }
  std::filesystem::remove_all(folder);
}

int measureAll(const Settings& settings) {
  sk::Device device(settings.device);
  const bench::PlainContext context(device.name());
  Report report(device.name());
  SideBySide sideBySide(device, context, settings, report);
  sideBySide.control(1024);
  for (const int size : {1024, 2048}) sideBySide.saxpy(size);
  for (const int size : {1024, 2048}) sideBySide.binomial(size);
  hostCost(device, settings, report);
  sumTime(device, settings, report);
  compileTimes(settings, report);
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
  CLI::App cli("Measures generated kernels against hand-written GLSL, the cost of a call, and skc's speed.",
               "sk_bench");
  cli.add_option("--device", s.device, "where to run (default: the best)");
  cli.add_option("--rounds", s.rounds, "rounds in which contenders take turns (default: 21)")
      ->check(CLI::Range(1, 10'000));
  cli.add_option("--sample", s.sampleMilliseconds, "milliseconds of a contender in each round (default: 30)")
      ->check(CLI::Range(0.1, 1e5));
  cli.add_option("--json", s.json, "write the results to this file as well");
  cli.add_option("--skc", s.skc, "the compiler (default: this build's)");
  cli.add_option("--sources", s.sources, "folder of the examples, whose .sk files are compiled");
  cli.add_flag("--check", s.check, "exit status 1 where a bar is missed");
  CLI11_PARSE(cli, argc, argv);
  try {
    return measureAll(s);
  } catch (const std::exception& error) {
    fmt::print(stderr, "sk_bench: {}\n", error.what());
    return 1;
  }
}
