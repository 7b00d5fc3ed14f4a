// SPDX-License-Identifier: MIT
//
// fuzz_kernels: compiles random correct kernels in this process, checks their GLSL with glslang, runs them on both fragment
// profiles, and compares their results with their meaning (kernels/model.hpp). Kernel N of a seed is always the same. The
// exit status is 1 after a finding, but crashes of the GL driver are counted separately.
#include <csignal>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>

#include <execinfo.h>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "command.hpp"
#include "driver/big_stack.hpp"
#include "driver/compile.hpp"
#include "glsl.hpp"
#include "isolation.hpp"
#include "kernels/device_run.hpp"
#include "program/descriptors.hpp"

namespace {

namespace fs = std::filesystem;
using skc::driver::Emit;

struct Options : fuzz::Command {
  Options() { count = 100, seconds = 120; }
  bool withoutDevice = false;
};

/// The devices of a child process: with the device's own limits, and both profiles with the guaranteed limits.
struct Devices {
  sk::Device many{sk::DeviceOptions{.profile = "glsl330", .limits = "device"}};
  sk::Device few{sk::DeviceOptions{.profile = "essl300", .textureLimit = 64, .limits = "guaranteed"}};
  sk::Device fewOfMany{sk::DeviceOptions{.profile = "glsl330", .textureLimit = 64, .limits = "guaranteed"}};
};

/// What a child keeps between kernels: devices identify descriptors by their addresses.
struct Kept {
  std::deque<skc::emit::Program> programs;
  std::optional<Devices> devices;
};

std::string check(const Options& options, const fuzz::RandomKernel& kernel, Kept& kept) {
  skc::driver::Options compiling;
  const auto [module, messages] = skc::driver::translateText(compiling, "random.sk", kernel.text());
  if (!module) return "refused: " + messages;
  std::vector<std::string> listings;
  compiling.emit = Emit::Glsl;
  for (const char* profile : {"glsl330", "essl300"}) {
    compiling.profile = profile;
    listings.push_back(emitText(compiling, *module));
  }
  if (const std::string complaint = fuzz::glslComplaint(listings); !complaint.empty()) return complaint;
  if (options.withoutDevice) return {};
  const skc::emit::Program& program = kept.programs.emplace_back(*module);
  if (!kept.devices) kept.devices.emplace();
  for (sk::Device* device : {&kept.devices->many, &kept.devices->few, &kept.devices->fewOfMany}) {
    const std::string wrong = fuzz::difference(*device, program.units()[0].kernel, kernel);
    if (!wrong.empty()) {
      return std::string(device->profile()) +
             (device == &kept.devices->many ? ": " : ", guaranteed limits: ") + wrong;
    }
  }
  return {};
}

/// Prints a stack trace to standard error before the process dies.
void traceDeath(int signal) {
  void* frames[40];
  const int count = backtrace(frames, 40);
  backtrace_symbols_fd(frames, count, STDERR_FILENO);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// Whether the innermost frame, apart from our own and those of the C library, is in the GL driver: in Mesa, or in its LLVM.
bool isDriversDeath(const fuzz::Finding& finding) {
  std::istringstream frames(finding.log);
  for (std::string frame; std::getline(frames, frame);) {
    const std::string file = fs::path(frame.substr(0, frame.find('('))).filename().string();
    if (file == "fuzz_kernels" || file.starts_with("libc.so")) continue;
    return file.ends_with("_dri.so") || file.starts_with("libgallium") || file.starts_with("libLLVM-1");
  }
  return false;
}

int fuzzKernels(const Options& options) {
  if (options.show) {
    for (std::uint64_t i = 0; i < options.count; ++i) {
      std::cout << fuzz::RandomKernel(options.seed, options.first + i).text() << "\n";
    }
    return 0;
  }
  Kept kept;
  std::uint64_t driverDeaths = 0;
  fuzz::Campaign campaign = options.campaign();
  campaign.batch = 25;
  campaign.begin = [] {
    for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) std::signal(signal, traceDeath);
  };
  campaign.check = [&](std::uint64_t number) {
    fuzz::Verdict verdict;
    skc::driver::withBigStack([&] {
      try {
        verdict.finding = check(options, fuzz::RandomKernel(options.seed, number), kept);
      } catch (const std::exception& error) {
        verdict.finding = std::string("throws ") + error.what();
      }
      if (kept.devices) {  // the next kernel runs on another thread
        kept.devices->many.release(), kept.devices->few.release(), kept.devices->fewOfMany.release();
      }
      return 0;
    });
    verdict.tally = verdict.finding.empty() ? "agree" : "do not";
    return verdict;
  };
  campaign.onFinding = [&](const fuzz::Finding& finding) {
    const bool isDrivers = isDriversDeath(finding);
    driverDeaths += isDrivers;
    const fs::path file =
        options.keep("kernel", finding, fuzz::RandomKernel(options.seed, finding.number).text());
    fuzz::tell(isDrivers ? "the driver died of kernel" : "kernel", finding,
               "fuzz_kernels --seed " + std::to_string(options.seed) + " --first " +
                   std::to_string(finding.number) + " --count 1   (" + file.string() + ")");
  };
  const fuzz::Summary summary = fuzz::run(campaign);
  fuzz::conclude(summary);
  if (driverDeaths != 0) std::cout << driverDeaths << " of the findings are deaths of the driver\n";
  return summary.findings == driverDeaths ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"fuzz_kernels: compares random kernels with what they mean", "fuzz_kernels"};
  options.addTo(app, "kernel");
  app.add_flag("--without-device", options.withoutDevice,
               "Compile them and show them to glslang, but do not run them");
  CLI11_PARSE(app, argc, argv);
  return fuzz::guarded("fuzz_kernels", [&] { return fuzzKernels(options); });
}
