// SPDX-License-Identifier: MIT
//
// The command line of skc.
//
// Reads devices as measured by `sk info --json`, as far as the compiler needs them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bounds/options.hpp"
#include "ir/ir.hpp"
#include "native/native.hpp"

namespace skc::driver {

struct MeasuredDevice {
  std::string name;
  ir::Limits limits;
};

/// The devices of a file that draw; native ones have no limits. Throws std::runtime_error for a bad file.
std::vector<MeasuredDevice> readDevices(const std::string& file);

enum class Emit : std::uint8_t { Stubs, Glsl, Ir, Plan, Ast, Llvm, Assembly, Json, Js, Bounds };

struct Options {
  std::vector<std::string> files;
  std::string outputDirectory = ".";
  Emit emit = Emit::Stubs;
  std::string profile = "glsl330";          ///< for --emit=glsl, plan and ir
  std::vector<MeasuredDevice>
      devices;      ///< to plan for, besides all profiles; with --emit=plan, in place of the profile
  std::string kernel;                       ///< the only kernel to emit; empty: all
  std::vector<std::string> includeDirectories, definitions, warnings;
  std::string depfile;                      ///< empty: none
  std::string printAfter;                   ///< a transform, "all", or empty
  std::string precision;  ///< of printed programs; for stubs, "single" omits all other variants
  bool fragmentTarget = true, computeTarget = true;  ///< kinds of GLSL programs that the stubs support
  bool nativeTarget = true;  ///< compile native code
  native::Options native;  ///< machine and code generation
  bool quad = false;  ///< native code also computes in __float128
  bool shadow = false;  ///< modules for browsers have what device.shadow() needs
  bool library = false;  ///< the stubs list their descriptors
  bool color = false;
  bool fixIts = false;  ///< also print fix-its for tools
  bool isolated = false;  ///< read no file but those to compile
  bounds::Options bounds;  ///< for --emit=bounds; precision and target are those above
  bool boundsAsJson = false;
};

/// The options, or the exit status if there is nothing to compile: 0 after --help and --version, 1 after an
/// error, which has been written to standard error.
struct CommandLine {
  std::optional<Options> options;
  int status = 0;
};
CommandLine parseCommandLine(int argc, const char* const* argv);

}  // namespace skc::driver
