// SPDX-License-Identifier: MIT
//
// Makes calls of all kinds in random order, as an application that runs for days does: memory and GL objects must not become more,
// and results keep their bits. `./dev soak --help`.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include "faults.hpp"
#include "scene.hpp"
#include "sk/sk.hpp"

namespace {

constexpr std::int64_t rows = 5;
/// What malloc may keep more at the end than after half of the calls, in bytes. Of GL objects, programs for instance, it may be a fiftieth:
/// a short run does not meet every one in its first half.
constexpr std::int64_t mostGrowth = std::int64_t{2} << 20;

struct Options {
  std::string target = "native";
  std::uint64_t calls = 100000;
  unsigned seed = 1;
};

std::int64_t residentBytes() {
  std::int64_t pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

class Soak {
 public:
  Soak(sk::Device& device, unsigned seed) : isNative_(device.profile() == "native"), random_(seed) {
    scene_ = std::make_unique<faults::Scene>(device, rows);
    for (const faults::Scenario& scenario : faults::scenarios()) {
      if (!isNative_ || !scenario.needsGl) scenarios_.push_back(&scenario);
    }
  }

  /// Calls of all kinds in random order, each after writes of what it reads. What other elements grow to is taken back now and then.
  void run(std::uint64_t calls) {
    for (std::uint64_t i = 0; i < calls; ++i) {
      if (i % 64 == 0) scene_->reset();
      scene_->resetInputs();
      scenarios_[random_() % scenarios_.size()]->call(*scene_);
    }
  }

  /// What each kind of call makes of the first elements.
  std::vector<faults::Scene::Elements> results() {
    std::vector<faults::Scene::Elements> all;
    for (const faults::Scenario* scenario : scenarios_) {
      scene_->reset();
      scenario->call(*scene_);
      all.push_back(scene_->elements());
    }
    scene_->reset();
    return all;
  }

  std::string nameOf(std::size_t scenario) const { return scenarios_[scenario]->name; }

 private:
  bool isNative_;
  std::mt19937 random_;
  std::unique_ptr<faults::Scene> scene_;
  std::vector<const faults::Scenario*> scenarios_;
};

/// What a part of the run, of ten, has left.
struct Sample {
  std::int64_t bytes = 0;
  faults::LiveObjects objects;
};

int soak(const Options& options) {
  faults::install();
  sk::Device device =
      options.target == "native" ? sk::Device::native() : sk::Device({.profile = options.target});
  Soak soak(device, options.seed);
  const std::vector<faults::Scene::Elements> first = soak.results();
  std::vector<Sample> samples;
  for (int part = 0; part < 10; ++part) {
    soak.run(options.calls / 10);
    const std::vector<faults::Scene::Elements> now = soak.results();
    for (std::size_t k = 0; k < now.size(); ++k) {
      if (now[k] == first[k]) continue;
      fmt::print("after {} calls, '{}' has another result\n",
                 options.calls / 10 * static_cast<std::uint64_t>(part + 1), soak.nameOf(k));
      return 1;
    }
    samples.push_back({residentBytes(), faults::liveObjects()});
    fmt::print("{:>3} %: {:.2f} MiB, {} GL objects\n", 10 * (part + 1),
               static_cast<double>(samples.back().bytes) / 0x1p20, samples.back().objects.objects);
    std::fflush(stdout);
  }
  const Sample &half = samples[4], &end = samples.back();
  const std::int64_t growth = end.bytes - half.bytes;
  const long more = end.objects.objects - half.objects.objects;
  fmt::print("{}: {} calls; in the second half {:+.2f} MiB, {:+} GL objects; {} deleted twice\n",
             options.target, options.calls, static_cast<double>(growth) / 0x1p20, more, end.objects.wrong);
  const bool isFlat = growth <= mostGrowth && more <= half.objects.objects / 50 && end.objects.wrong == 0;
  return isFlat ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "soak: makes calls of all kinds in random order; memory, GL objects and results must stay as they are"};
  app.add_option("--target", options.target, "What to run on: native, glsl330, glsl430, essl300 or essl310")
      ->check(CLI::IsMember({"native", "glsl330", "glsl430", "essl300", "essl310"}))
      ->capture_default_str();
  app.add_option("--calls", options.calls, "How many calls")
      ->check(CLI::Range(std::uint64_t{100}, std::uint64_t{1} << 40U))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Which order")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return soak(options);
  } catch (const std::exception& error) {
    std::cerr << "soak: " << error.what() << '\n';
    return 1;
  }
}
