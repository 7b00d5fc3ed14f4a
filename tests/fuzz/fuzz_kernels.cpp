// SPDX-License-Identifier: MIT
//
// fuzz_kernels: compiles random correct kernels in this process, checks their GLSL with glslang, runs them on both fragment
// profiles, and compares their results with their meaning (kernels/model.hpp). Every eighth is a scan (kernels/scans.hpp),
// which is also dispatched. Kernel N of a seed is always the same. The exit status is 1 after a finding, but crashes of
// the GL driver are counted separately.
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
#include "kernels/scans.hpp"
#include "program/descriptors.hpp"

namespace {

namespace fs = std::filesystem;
using skc::driver::Emit;

struct Options : fuzz::Command {
  Options() { count = 100, seconds = 120; }
  bool withoutDevice = false;
};

/// The devices of a child process: with the device's own limits, and both fragment profiles with the guaranteed limits.
struct Devices {
  sk::Device many{sk::DeviceOptions{.profile = "glsl330", .limits = "device"}};
  sk::Device few{sk::DeviceOptions{.profile = "essl300", .textureLimit = 64, .limits = "guaranteed"}};
  sk::Device fewOfMany{sk::DeviceOptions{.profile = "glsl330", .textureLimit = 64, .limits = "guaranteed"}};
  sk::Device dispatching{sk::DeviceOptions{.profile = "glsl430"}};  ///< for scans

  void release() {
    for (sk::Device* device : {&many, &few, &fewOfMany, &dispatching}) device->release();
  }
};

/// What a child keeps between kernels: devices identify descriptors by their addresses.
struct Kept {
  std::deque<skc::emit::Program> programs;
  std::optional<Devices> devices;
};

/// Every eighth program is a scan.
bool isScan(std::uint64_t number) { return number % 8 == 7; }

std::string textOf(const Options& options, std::uint64_t number) {
  return isScan(number) ? fuzz::RandomScan(options.seed, number).text()
                        : fuzz::RandomKernel(options.seed, number).text();
}

/// Compiles a program and checks its GLSL. Calls differenceOn(device, unit) for each of the devices.
template <class DifferenceOn>
std::string check(const Options& options, const std::string& text, bool dispatches, Kept& kept,
                  DifferenceOn&& differenceOn) {
  skc::driver::Options compiling;
  const auto [module, messages] = skc::driver::translateText(compiling, "random.sk", text);
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
  std::vector<sk::Device*> devices{&kept.devices->many, &kept.devices->few, &kept.devices->fewOfMany};
  if (dispatches) devices.push_back(&kept.devices->dispatching);
  for (sk::Device* device : devices) {
    const std::string wrong = differenceOn(*device, program.units()[0]);
    if (wrong.empty()) continue;
    const bool isLimited = device == &kept.devices->few || device == &kept.devices->fewOfMany;
    return std::string(device->profile()) + (isLimited ? ", guaranteed limits: " : ": ") + wrong;
  }
  return {};
}

std::string check(const Options& options, std::uint64_t number, Kept& kept) {
  if (isScan(number)) {
    const fuzz::RandomScan scan(options.seed, number);
    return check(options, scan.text(), true, kept, [&](sk::Device& device, const skc::emit::Unit& unit) {
      return scan.difference(device, *unit.reduction);
    });
  }
  const fuzz::RandomKernel kernel(options.seed, number);
  return check(options, kernel.text(), false, kept, [&](sk::Device& device, const skc::emit::Unit& unit) {
    return fuzz::difference(device, unit.kernel, kernel);
  });
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
      std::cout << textOf(options, options.first + i) << "\n";
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
        verdict.finding = check(options, number, kept);
      } catch (const std::exception& error) {
        verdict.finding = std::string("throws ") + error.what();
      }
      if (kept.devices) kept.devices->release();  // the next kernel runs on another thread
      return 0;
    });
    verdict.tally = verdict.finding.empty() ? "agree" : "do not";
    return verdict;
  };
  campaign.onFinding = [&](const fuzz::Finding& finding) {
    const bool isDrivers = isDriversDeath(finding);
    driverDeaths += isDrivers;
    const fs::path file = options.keep("kernel", finding, textOf(options, finding.number));
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
