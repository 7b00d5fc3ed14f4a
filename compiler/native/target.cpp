// SPDX-License-Identifier: MIT
#include "native/target.hpp"

#include <algorithm>
#include <mutex>
#include <span>

#include <fmt/format.h>

#include <llvm/MC/TargetRegistry.h>
#include <llvm/Support/TargetSelect.h>
#include <llvm/TargetParser/Host.h>
#include <llvm/TargetParser/Triple.h>

namespace skc::native {

using sk::native::Level;

namespace {

constexpr CpuLevel x86Levels[] = {
    {.name = "x86-64",
     .level = Level::Base,
     .vectorBits = 128,
     .vectorRegisters = 16,
     .hasMaskRegisters = false,
     .hasFusedMultiplyAdd = false,
     .convertsHalves = false},
    {.name = "x86-64-v3",
     .level = Level::V3,
     .vectorBits = 256,
     .vectorRegisters = 16,
     .hasMaskRegisters = false,
     .hasFusedMultiplyAdd = true,
     .convertsHalves = true},
    {.name = "x86-64-v4",
     .level = Level::V4,
     .vectorBits = 512,
     .vectorRegisters = 32,
     .hasMaskRegisters = true,
     .hasFusedMultiplyAdd = true,
     .convertsHalves = true},
};
constexpr CpuLevel armLevels[] = {
    {.name = "",
     .level = Level::Base,
     .vectorBits = 128,
     .vectorRegisters = 32,
     .hasMaskRegisters = false,
     .hasFusedMultiplyAdd = true,
     .convertsHalves = true},
};
constexpr CpuLevel otherLevels[] = {
    {.name = "",
     .level = Level::Base,
     .vectorBits = 128,
     .vectorRegisters = 16,
     .hasMaskRegisters = false,
     .hasFusedMultiplyAdd = false,
     .convertsHalves = false},
};

std::string normalized(const std::string& triple) {
  return triple.empty() ? llvm::sys::getDefaultTargetTriple() : llvm::Triple::normalize(triple);
}

std::span<const CpuLevel> levelsOf(const std::string& triple) {
  const llvm::Triple machine(triple);
  if (machine.getArch() == llvm::Triple::x86_64) return x86Levels;
  if (machine.isAArch64()) return armLevels;
  return otherLevels;
}

void initialize() {
  static std::once_flag once;
  std::call_once(once, [] {
    llvm::InitializeAllTargetInfos();
    llvm::InitializeAllTargets();
    llvm::InitializeAllTargetMCs();
    llvm::InitializeAllAsmPrinters();
  });
}

const llvm::Target& findTarget(const std::string& triple) {
  initialize();
  std::string why;
  const llvm::Target* const target = llvm::TargetRegistry::lookupTarget(triple, why);
  if (target == nullptr) {
    throw Error(fmt::format("unknown target triple '{}'; use one like x86_64-linux-gnu or aarch64-linux-gnu",
                            triple));
  }
  if (!llvm::Triple(triple).isArch64Bit() || !llvm::Triple(triple).isLittleEndian()) {
    throw Error(
        fmt::format("target triple '{}' is not a 64-bit little-endian machine, which native code is for; use "
                    "--target=fragment,compute there",
                    triple));
  }
  return *target;
}

/// The best of the target's levels that this machine has.
std::string_view levelOfThisMachine(const std::string& triple) {
  if (llvm::Triple(triple).getArch() != llvm::Triple(llvm::sys::getProcessTriple()).getArch()) {
    throw Error(
        fmt::format("level 'native' is this machine's, which target '{}' is not; name its levels", triple));
  }
  const std::span<const CpuLevel> known = levelsOf(triple);
  return std::ranges::find(known, known.size() == 1 ? Level::Base : sk::native::levelOfHardware(),
                           &CpuLevel::level)
      ->name;
}

std::vector<CpuLevel> chosenLevels(const std::string& triple, std::vector<std::string> names) {
  const std::span<const CpuLevel> known = levelsOf(triple);
  if (names.empty()) return {known.begin(), known.end()};
  for (std::string& name : names) {
    if (name == "native") name = levelOfThisMachine(triple);
  }
  for (const std::string& name : names) {
    if (std::ranges::find(known, name, &CpuLevel::name) != known.end()) continue;
    std::string list;
    for (const CpuLevel& level : known) list += fmt::format("{}{}", list.empty() ? "" : ", ", level.name);
    throw Error(known.size() == 1
                    ? fmt::format("target '{}' has no levels of the CPU; leave out --levels", triple)
                    : fmt::format("unknown level '{}' of the CPU; use one of {}, or native", name, list));
  }
  std::vector<CpuLevel> chosen;
  for (const CpuLevel& level : known) {
    if (std::ranges::find(names, level.name) != names.end()) chosen.push_back(level);
  }
  return chosen;
}

void checkLanes(std::uint32_t lanes) {
  const bool isPowerOf2 = lanes != 0 && (lanes & (lanes - 1)) == 0;
  if (lanes == 0 || (isPowerOf2 && lanes <= sk::native::mostLanes)) return;
  throw Error(
      fmt::format("{} lanes are not possible; use a power of 2 from 1 to {}", lanes, sk::native::mostLanes));
}

}  // namespace

Target::Target(const Options& options) : triple_(normalized(options.triple)) {
  checkLanes(options.lanes);
  const llvm::Target& target = findTarget(triple_);
  levels_ = chosenLevels(triple_, options.levels);
  llvm::TargetOptions targetOptions;
  targetOptions.AllowFPOpFusion = llvm::FPOpFusion::Standard;  // fuses only marked operations
  machine_.reset(target.createTargetMachine(
      triple_, levels_.front().name, "", targetOptions, llvm::Reloc::PIC_, std::nullopt,
      options.optimizes ? llvm::CodeGenOptLevel::Default : llvm::CodeGenOptLevel::None));
}

void setLevel(llvm::Function& function, const CpuLevel& level) {
  if (level.name.empty()) return;
  function.addFnAttr("target-cpu", level.name);
  const std::string bits = std::to_string(level.vectorBits);
  function.addFnAttr("prefer-vector-width", bits);
  function.addFnAttr("min-legal-vector-width", bits);
}

void checkOptions(const Options& options) { const Target target(options); }

std::vector<std::string_view> levelNames(const std::string& triple) {
  std::vector<std::string_view> names;
  for (const CpuLevel& level : levelsOf(normalized(triple))) {
    if (!level.name.empty()) names.push_back(level.name);
  }
  return names;
}

}  // namespace skc::native
