// SPDX-License-Identifier: MIT
//
// The command line of skc.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "driver/device_file.hpp"
#include "native/native.hpp"

namespace skc::driver {

enum class Emit : std::uint8_t { Stubs, Glsl, Ir, Plan, Ast, Llvm, Assembly };

struct Options {
  std::vector<std::string> files;
  std::string outputDirectory = ".";
  Emit emit = Emit::Stubs;
  std::string profile = "glsl330";          ///< of --emit=glsl and plan
  std::vector<MeasuredDevice>
      devices;      ///< to plan for, beside all profiles; of --emit=plan instead of the profile
  std::string kernel;                       ///< the only one to emit; empty: all
  std::vector<std::string> includeDirectories, definitions, warnings;
  std::string depfile;                      ///< empty: none
  std::string printAfter;                   ///< a transform, "all", or empty
  std::string precision;  ///< of what is printed; of stubs: "single" leaves out all other forms
  bool fragmentTarget = true, computeTarget = true;  ///< what the stubs' GLSL may run as
  bool nativeTarget = true;  ///< native code is compiled
  native::Options native;  ///< for which machine, and how
  bool quad = false;  ///< it computes in __float128, too
  bool library = false;  ///< the stubs have a list of their descriptors
  bool color = false;
  bool fixIts = false;  ///< print fix-its for tools, too
};

/// The options, or the exit status where there is nothing to compile: 0 after --help and --version,
/// 1 after a mistake, which is on standard error by then.
struct CommandLine {
  std::optional<Options> options;
  int status = 0;
};
CommandLine parseCommandLine(int argc, const char* const* argv);

}  // namespace skc::driver
