// SPDX-License-Identifier: MIT
//
// fuzz_kernels: compiles random correct kernels in this process, checks their GLSL with glslang, runs them on both fragment
// profiles and as native code, and compares their results with their meaning (kernels/model.hpp). Three of eight are scans,
// reduces, and kernels with folded outputs (kernels/folds.hpp), which are also dispatched. Kernel N of a seed is always the
// same. The exit status is 1 after a finding, but crashes of the GL driver are counted separately.
#include <algorithm>
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
#include "kernels/folds.hpp"
#include "kernels/native_code.hpp"
#include "program/descriptors.hpp"

namespace {

namespace fs = std::filesystem;
using skc::driver::Emit;

struct Options : fuzz::Command {
  Options() { count = 100, seconds = 120; }
  bool withoutGl = false, withoutNative = false;
};

/// The GL devices of a child process: with the device's own limits, and both fragment profiles with the guaranteed limits.
struct GlDevices {
  sk::Device many{sk::DeviceOptions{.profile = "glsl330", .limits = "device"}};
  sk::Device few{sk::DeviceOptions{.profile = "essl300", .textureLimit = 64, .limits = "guaranteed"}};
  sk::Device fewOfMany{sk::DeviceOptions{.profile = "glsl330", .textureLimit = 64, .limits = "guaranteed"}};
  sk::Device dispatching{sk::DeviceOptions{.profile = "glsl430"}};  ///< for folds and append outputs

  void release() {
    for (sk::Device* device : {&many, &few, &fewOfMany, &dispatching}) device->release();
  }
};

struct NativeDevices {
  sk::Device native{sk::DeviceOptions{.device = "native"}};
  sk::Device reference{sk::DeviceOptions{.device = "reference"}};

  void release() {
    for (sk::Device* device : {&native, &reference}) device->release();
  }
};

/// What a child keeps between kernels: devices identify descriptors by their addresses.
struct Kept {
  std::deque<skc::emit::Program> programs;
  std::optional<GlDevices> gl;
  std::optional<NativeDevices> native;

  void release() {
    if (gl) gl->release();
    if (native) native->release();
  }
};

/// Three of eight programs fold.
std::optional<fuzz::FoldKind> foldKindOf(std::uint64_t number) {
  switch (number % 8) {
    case 2: return fuzz::FoldKind::Reduce;
    case 4: return fuzz::FoldKind::Kernel;
    case 7: return fuzz::FoldKind::Scan;
    default: return std::nullopt;
  }
}

std::string textOf(const Options& options, std::uint64_t number) {
  const auto kind = foldKindOf(number);
  return kind ? fuzz::RandomFold(options.seed, number, *kind).text()
              : fuzz::RandomKernel(options.seed, number).text();
}

std::string glslComplaint(const skc::ir::Module& module) {
  skc::driver::Options options;
  options.emit = Emit::Glsl;
  std::vector<std::string> listings;
  for (const char* profile : {"glsl330", "essl300"}) {
    options.profile = profile;
    listings.push_back(emitText(options, module));
  }
  return fuzz::glslComplaint(listings);
}

bool appends(const sk::program::Kernel& kernel) {
  return std::ranges::any_of(kernel.parameters, [](const sk::program::Parameter& parameter) {
    return parameter.role == sk::program::Role::VariableOutput ||
           parameter.role == sk::program::Role::Scatter;
  });
}

/// Calls differenceOn(device, unit) for each GL device.
template <class DifferenceOn>
std::string glDifference(const skc::ir::Module& module, bool folds, Kept& kept, DifferenceOn&& differenceOn) {
  const skc::emit::Program& program = kept.programs.emplace_back(module);
  if (!kept.gl) kept.gl.emplace();
  std::vector<sk::Device*> devices{&kept.gl->many, &kept.gl->few, &kept.gl->fewOfMany};
  if (folds || appends(program.units()[0].kernel)) devices.push_back(&kept.gl->dispatching);
  for (sk::Device* device : devices) {
    const std::string wrong = differenceOn(*device, program.units()[0]);
    if (wrong.empty()) continue;
    const bool isLimited = device == &kept.gl->few || device == &kept.gl->fewOfMany;
    return std::string(device->profile()) + (isLimited ? ", guaranteed limits: " : ": ") + wrong;
  }
  return {};
}

/// Calls differenceOn(device, unit) for each native device, with code for one level of the CPU.
template <class DifferenceOn>
std::string nativeDifference(const skc::ir::Module& module, std::uint64_t number, Kept& kept,
                             DifferenceOn&& differenceOn) {
  static const std::vector<std::string> levels = fuzz::supportedLevels();
  const std::string& level = levels[number % levels.size()];
  const skc::emit::Program& program = kept.programs.emplace_back(fuzz::withNativeCode(module, level));
  if (!kept.native) kept.native.emplace();
  for (sk::Device* device : {&kept.native->native, &kept.native->reference}) {
    const std::string wrong = differenceOn(*device, program.units()[0]);
    if (wrong.empty()) continue;
    return (device == &kept.native->native ? "native, " : "reference, ") + level + ": " + wrong;
  }
  return {};
}

/// Compiles a program, checks its GLSL, and calls differenceOn(device, unit) for each device.
template <class DifferenceOn>
std::string check(const Options& options, std::uint64_t number, const std::string& text, Kept& kept,
                  DifferenceOn&& differenceOn) {
  const auto [module, messages] = skc::driver::translateText({}, "random.sk", text);
  if (!module) return "refused: " + messages;
  if (const std::string complaint = glslComplaint(*module); !complaint.empty()) return complaint;
  std::string wrong;
  if (!options.withoutNative) wrong = nativeDifference(*module, number, kept, differenceOn);
  if (!options.withoutGl && wrong.empty())
    wrong = glDifference(*module, foldKindOf(number).has_value(), kept, differenceOn);
  return wrong;
}

std::string check(const Options& options, std::uint64_t number, Kept& kept) {
  if (const auto kind = foldKindOf(number)) {
    const fuzz::RandomFold fold(options.seed, number, *kind);
    return check(options, number, fold.text(), kept, [&](sk::Device& device, const skc::emit::Unit& unit) {
      return fold.difference(device, *unit.reduction);
    });
  }
  const fuzz::RandomKernel kernel(options.seed, number);
  return check(options, number, kernel.text(), kept, [&](sk::Device& device, const skc::emit::Unit& unit) {
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
      kept.release();  // the next kernel runs on another thread
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
  app.add_flag("--without-gl", options.withoutGl, "Show their GLSL to glslang, but do not run it");
  app.add_flag("--without-native", options.withoutNative, "Do not run native code");
  CLI11_PARSE(app, argc, argv);
  return fuzz::guarded("fuzz_kernels", [&] { return fuzzKernels(options); });
}
