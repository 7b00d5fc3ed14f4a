// SPDX-License-Identifier: MIT
#include "driver/options.hpp"

#include <algorithm>
#include <map>

#include <unistd.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "assemble/assemble.hpp"
#include "transforms/transforms.hpp"

namespace skc::driver {
namespace {

const std::map<std::string, Emit> emits = {{"stubs", Emit::Stubs}, {"glsl", Emit::Glsl}, {"cpp", Emit::Cpp},
                                           {"ir", Emit::Ir},       {"plan", Emit::Plan}, {"ast", Emit::Ast}};

std::string profileNames() {
  std::string names;
  for (const sk::assemble::Profile& profile : sk::assemble::profiles()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", profile.name);
  }
  return names;
}

std::string transformList() {
  std::string names;
  for (const std::string_view name : skc::transformNames()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  }
  return names;
}

/// A message for a value that is not allowed, or "".
std::string checkEmit(const std::string& value) {
  if (emits.contains(value)) return {};
  return fmt::format("'{}' is none of stubs, glsl, cpp, ir, plan, ast", value);
}

std::string checkProfile(const std::string& value) {
  if (sk::assemble::findProfile(value)) return {};
  return fmt::format("'{}' is none of {}", value, profileNames());
}

std::string checkTarget(const std::string& value) {
  if (value == "fragment" || value == "compute" || value == "native") return {};
  return fmt::format("'{}' is no target; use fragment, compute, native", value);
}

std::string checkTransform(const std::string& value) {
  const auto names = skc::transformNames();
  if (value == "all" || std::find(names.begin(), names.end(), value) != names.end()) return {};
  return fmt::format("'{}' is no transform; use all, {}", value, transformList());
}

/// `skc a/x.sk b/x.sk -o out` would write out/x.sk.hpp twice.
std::string duplicateStem(const std::vector<std::string>& files) {
  std::map<std::string, std::string> seen;
  for (const std::string& file : files) {
    const std::string name = file.substr(file.find_last_of('/') + 1);
    const auto [entry, isNew] = seen.emplace(name, file);
    if (!isNew)
      return fmt::format("'{}' and '{}' would both be written to {}.hpp; compile them apart", entry->second,
                         file, name);
  }
  return {};
}

}  // namespace

CommandLine parseCommandLine(int argc, const char* const* argv) {
  Options options;
  std::string emit = "stubs", color = "auto";
  std::vector<std::string> targets;
  std::string deviceFile;
  CLI::App app{
      "skc: compiles StreamKernel files (.sk) to GLSL, descriptors and C++ stubs.\n"
      "FILE.sk becomes FILE.sk.hpp and FILE.sk.cpp.",
      "skc"};
  app.get_formatter()->column_width(30);
  app.set_version_flag("--version", "skc " SKC_VERSION);
  app.add_option("FILE", options.files, ".sk files to compile")->required();
  app.add_option("-o", options.outputDirectory,
                 "Write the stubs to this directory (default: the current one)")
      ->type_name("DIR");
  app.add_option("--emit", emit, "What to emit: stubs, or glsl, cpp, ir, plan, ast on standard output")
      ->check(checkEmit, "")
      ->type_name("KIND");
  app.add_option("--target", targets, "Targets that the stubs serve (default: fragment,compute,native)")
      ->delimiter(',')
      ->check(checkTarget, "")
      ->type_name("LIST");
  app.add_option("--precision", options.precision,
                 "What floats are computed in, for --emit=glsl, ir and plan: single (default), half, "
                 "extended or double; "
                 "stubs have all forms, but for 'single'")
      ->check(CLI::IsMember({"single", "half", "extended", "double"}));
  app.add_flag("--quad", options.quad,
               "Native code for the reference in __float128, too; programs with it link quadmath");
  app.add_flag("--library", options.library,
               "The stubs list all kernels and reduces, for programs that load them: sk/library.hpp");
  app.add_option("--profile", options.profile,
                 "Version of GLSL that --emit=glsl and plan are about: " + profileNames())
      ->check(checkProfile, "")
      ->type_name("NAME");
  app.add_option("--device", deviceFile,
                 "Plan the passes of large kernels for the devices in this file of sk info --json, too")
      ->type_name("FILE");
  app.add_option("--kernel", options.kernel, "Emit only this kernel or reduce")->type_name("NAME");
  app.add_option("-I", options.includeDirectories, "Look for #include files in this directory")
      ->type_name("DIR")
      ->allow_extra_args(false);
  app.add_option("-D", options.definitions, "Define a macro")
      ->type_name("NAME[=VALUE]")
      ->allow_extra_args(false);
  app.add_option("-W", options.warnings, "Warnings, as Clang names them, and 'performance': what keeps kernels from full speed; -Werror makes "
                 "them errors")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app.add_option("--depfile", options.depfile, "Write the files that the stubs depend on, as a Makefile rule")
      ->type_name("FILE");
  app.add_option("--print-after", options.printAfter,
                 "Print the IR after this transform: all, " + transformList())
      ->check(checkTransform, "")
      ->type_name("NAME");
  app.add_option("--color", color, "Colour the messages: auto, always, never")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->type_name("WHEN");
  app.add_flag("--fixits", options.fixIts,
               "Print the mends of messages as Clang's -fdiagnostics-parseable-fixits does");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    app.exit(success);
    return {std::nullopt, 0};
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "skc: {}\nsee 'skc --help'\n", error.what());
    return {std::nullopt, 1};
  }
  const std::string clash = options.emit == Emit::Stubs ? duplicateStem(options.files) : "";
  options.emit = emits.at(emit);
  const auto serves = [&](std::string_view target) {
    return targets.empty() || std::ranges::find(targets, target) != targets.end();
  };
  options.fragmentTarget = serves("fragment");
  options.computeTarget = serves("compute");
  options.nativeTarget = serves("native");
  if (options.emit == Emit::Stubs && !clash.empty()) {
    fmt::print(stderr, "skc: {}\n", clash);
    return {std::nullopt, 1};
  }
  try {
    if (!deviceFile.empty()) options.devices = readDevices(deviceFile);
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "skc: {}\n", error.what());
    return {std::nullopt, 1};
  }
  options.color = color == "always" || (color == "auto" && isatty(STDERR_FILENO));
  return {std::move(options), 0};
}

}  // namespace skc::driver
