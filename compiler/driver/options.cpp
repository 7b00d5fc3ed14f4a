// SPDX-License-Identifier: MIT
#include "driver/options.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include <unistd.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "assemble/assemble.hpp"
#include "assemble/nearest_word.hpp"
#include "transforms/predicate.hpp"
#include "transforms/transforms.hpp"

namespace skc::driver {
namespace {

const std::map<std::string, Emit> emits = {
    {"stubs", Emit::Stubs}, {"glsl", Emit::Glsl},    {"ir", Emit::Ir},        {"plan", Emit::Plan},
    {"ast", Emit::Ast},     {"llvm", Emit::Llvm},    {"asm", Emit::Assembly}, {"json", Emit::Json},
    {"js", Emit::Js},       {"bounds", Emit::Bounds}};

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
    names += fmt::format("{}, ", name);
  }
  return names + std::string(skc::predicateName);
}

/// An error message if the value is not allowed, or "".
std::string checkEmit(const std::string& value) {
  if (emits.contains(value)) return {};
  return fmt::format("'{}' is none of stubs, js, glsl, ir, plan, bounds, ast, llvm, asm, json", value);
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
  const bool isKnown = value == "all" || value == skc::predicateName;
  if (isKnown || std::find(names.begin(), names.end(), value) != names.end()) return {};
  return fmt::format("'{}' is no transform; use all, {}", value, transformList());
}

/// An error message if `skc a/x.sk b/x.sk -o out` would write out/x.sk.hpp twice, or "".
std::string checkStems(const std::vector<std::string>& files) {
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

/// The command line as parsed, before its options are checked against each other.
struct Words {
  Options options;
  std::string emit = "stubs", color = "auto";
  std::vector<std::string> targets, ranges;
  std::string deviceFile;
  int optimization = 2;
};

void addOutputOptions(CLI::App& app, Words& words) {
  app.add_option("-o", words.options.outputDirectory,
                 "Write the stubs and objects to this directory (default: the current one)")
      ->type_name("DIR");
  app.add_option("--emit", words.emit,
                 "Write stubs and objects (stubs, the default) or a module for browsers (js), or print one "
                 "of glsl, ir, plan, bounds, ast, llvm, "
                 "asm, json")
      ->check(checkEmit, "")
      ->type_name("KIND");
  app.add_option("--kernel", words.options.kernel, "Emit only this kernel or reduce")->type_name("NAME");
  app.add_option(
         "--precision", words.options.precision,
         "Precision that --emit prints: single (default), half, extended or double. Stubs have all of "
         "them; with 'single', only that one")
      ->check(CLI::IsMember({"single", "half", "extended", "double"}));
  app.add_flag("--shadow", words.options.shadow,
               "Add to modules for browsers what device.shadow() computes beside the kernels, in doubles");
  app.add_flag(
      "--library", words.options.library,
      "Add a list of all kernels and reduces to the stubs, for programs that load them (sk/library.hpp)");
  app.add_option("--depfile", words.options.depfile,
                 "Write a Makefile rule with the files that the outputs depend on")
      ->type_name("FILE");
  app.add_option("--print-after", words.options.printAfter,
                 "Print the IR after this transform: all, " + transformList())
      ->check(checkTransform, "")
      ->type_name("NAME");
}

void addSourceOptions(CLI::App& app, Words& words) {
  app.add_option("FILE", words.options.files, ".sk files to compile")->required();
  app.add_option("-I", words.options.includeDirectories, "Search this directory for #include files")
      ->type_name("DIR")
      ->allow_extra_args(false);
  app.add_option("-D", words.options.definitions, "Define a macro")
      ->type_name("NAME[=VALUE]")
      ->allow_extra_args(false);
  app.add_option("-W", words.options.warnings,
                 "Enable or disable a warning by Clang's name for it, or 'performance': what keeps kernels "
                 "from full speed; "
                 "-Werror turns warnings into errors")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app.add_option("--color", words.color, "Colour messages: auto, always or never")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->type_name("WHEN");
  app.add_flag("--fixits", words.options.fixIts,
               "Print fix-its in the form of Clang's -fdiagnostics-parseable-fixits");
  app.add_flag("--isolated", words.options.isolated,
               "Read no file but FILE: #include and #embed find nothing, for programs of strangers");
}

void addTargetOptions(CLI::App& app, Words& words) {
  app.add_option("--target", words.targets, "Targets to compile for (default: fragment,compute,native)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(checkTarget, "")
      ->type_name("LIST");
  app.add_option("--profile", words.options.profile,
                 "Version of GLSL for --emit=glsl, plan and ir: " + profileNames())
      ->check(checkProfile, "")
      ->type_name("NAME");
  app.add_option("--device", words.deviceFile,
                 "Also plan the passes of large kernels for the devices in this output of 'sk info --json'")
      ->type_name("FILE");
}

void addNativeOptions(CLI::App& app, Words& words) {
  native::Options& options = words.options.native;
  app.add_option("--target-triple", options.triple,
                 "Compile native code for this system, such as aarch64-linux-gnu (default: this machine's)")
      ->type_name("TRIPLE");
  app.add_option(
         "--levels", options.levels,
         fmt::format(
             "Compile native code for these levels of the CPU (default: all). Those of x86-64: {}; native: "
             "this machine's",
             fmt::join(native::levelNames("x86_64-linux-gnu"), ", ")))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LIST");
  app.add_option("--lanes", options.lanes,
                 "Elements that native code computes together (default: chosen for each kernel)")
      ->type_name("N");
  app.add_flag("-g", options.debugInfo, "Add debug information for the .sk file to the objects");
  app.add_option("-O", words.optimization,
                 "Optimise native code (2, the default), or keep every variable where debuggers find it (0)")
      ->check(CLI::IsMember({0, 2}))
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)
      ->type_name("LEVEL");
  app.add_flag(
      "--quad", words.options.quad,
      "Also compile native code that computes in __float128, as a reference for accuracy; programs with "
      "it link libquadmath");
}

/// CLI11's own check of positive numbers prints its limits with hundreds of digits.
std::string checkElements(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool isNumber = error == std::errc() && end == text.data() + text.size();
  if (isNumber && number > 0 && number <= std::numeric_limits<double>::max()) return {};
  return fmt::format("'{}' is no number of elements; give one such as 1000 or 1e6", text);
}

void addBoundsOptions(CLI::App& app, Words& words) {
  app.add_option("--range", words.ranges,
                 "--emit=bounds: the numbers that a parameter, a member or a component has, such as x=0:1, "
                 "v.x=-1:1 or n=8")
      ->allow_extra_args(false)
      ->type_name("NAME=LOW:HIGH");
  app.add_option("--elements", words.options.bounds.elements,
                 "--emit=bounds: how many elements reduces and scans fold")
      ->check(checkElements, "")
      ->type_name("N");
  app.add_flag("--json", words.options.boundsAsJson, "--emit=bounds: print JSON");
}

/// Fills in what --emit=bounds needs. Returns an error message, or "".
std::string setBounds(Words& words) {
  Options& options = words.options;
  if (options.emit != Emit::Bounds) {
    const bool isGiven = !words.ranges.empty() || options.bounds.elements > 0 || options.boundsAsJson;
    return isGiven ? "--range, --elements and --json are for --emit=bounds" : "";
  }
  if (words.targets.size() > 1 || (words.targets.size() == 1 && words.targets[0] == "compute"))
    return "--emit=bounds takes one target, native or fragment";
  options.bounds.target = words.targets.size() == 1 && words.targets[0] == "fragment"
                              ? bounds::Target::Fragment
                              : bounds::Target::Native;
  options.bounds.isPrecisionGiven = !options.precision.empty();
  options.bounds.precision = options.precision == "half"       ? bounds::Precision::Half
                             : options.precision == "extended" ? bounds::Precision::Extended
                             : options.precision == "double"   ? bounds::Precision::Double
                                                               : bounds::Precision::Single;
  try {
    for (const std::string& range : words.ranges) options.bounds.ranges.push_back(bounds::parseRange(range));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

/// Sets the options that depend on several arguments. Returns an error message if they conflict, or "".
std::string checkTogether(Words& words) {
  Options& options = words.options;
  options.emit = emits.at(words.emit);
  const auto serves = [&](std::string_view target) {
    return words.targets.empty() || std::ranges::find(words.targets, target) != words.targets.end();
  };
  if (options.emit == Emit::Js) options.profile = "webgl2";
  options.fragmentTarget = serves("fragment");
  options.computeTarget = serves("compute");
  options.nativeTarget = serves("native");
  options.native.optimizes = words.optimization != 0;
  options.color = words.color == "always" || (words.color == "auto" && isatty(STDERR_FILENO));
  const bool printsNative = options.emit == Emit::Llvm || options.emit == Emit::Assembly;
  if (const std::string mistake = setBounds(words); !mistake.empty()) return mistake;
  if (options.shadow && options.emit != Emit::Js)
    return "--shadow adds to modules for browsers; write --emit=js, too, or leave it out";
  if (options.isolated && !options.includeDirectories.empty())
    return "--isolated reads no included file; leave out -I";
  if (printsNative && !options.nativeTarget)
    return fmt::format("--emit={} prints native code; leave out --target, or add native to it", words.emit);
  try {
    if (options.nativeTarget) native::checkOptions(options.native);
    if (!words.deviceFile.empty()) options.devices = readDevices(words.deviceFile);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return options.emit == Emit::Stubs || options.emit == Emit::Js ? checkStems(options.files) : "";
}

/// "; did you mean '--emit'?" for the first unknown option, or "".
std::string suggestion(const CLI::App& app) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const std::string& word : app.remaining()) {
    if (!word.starts_with("--")) continue;
    const std::string_view nearest = sk::assemble::nearestWord(word.substr(0, word.find('=')), known);
    return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
  }
  return {};
}

}  // namespace

CommandLine parseCommandLine(int argc, const char* const* argv) {
  Words words;
  CLI::App app{
      "skc compiles StreamKernel files (.sk): FILE.sk becomes the C++ stubs FILE.sk.hpp and FILE.sk.cpp,\n"
      "which contain the GLSL, and the native object file FILE.sk.o. A program links both.",
      "skc"};
  app.get_formatter()->column_width(30);
  app.set_version_flag("--version", "skc " SKC_VERSION);
  addOutputOptions(app, words);
  addSourceOptions(app, words);
  addTargetOptions(app, words);
  addNativeOptions(app, words);
  addBoundsOptions(app, words);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    app.exit(success);
    return {std::nullopt, 0};
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "skc: {}{}\nsee 'skc --help'\n", error.what(), suggestion(app));
    return {std::nullopt, 1};
  }
  if (const std::string mistake = checkTogether(words); !mistake.empty()) {
    fmt::print(stderr, "skc: {}\n", mistake);
    return {std::nullopt, 1};
  }
  return {std::move(words.options), 0};
}

namespace {

/// What every device that runs kernels guarantees (ES 3.0).
constexpr ir::Limits least{.drawBuffers = 4, .textureUnits = 16};

/// Throws std::out_of_range if the limit is missing or too small.
std::uint32_t limitOf(const nlohmann::json& limits, const char* name, std::uint32_t atLeast) {
  constexpr std::uint64_t most = std::numeric_limits<std::int32_t>::max();
  const nlohmann::json& limit = limits.at(name);
  const std::uint64_t number = limit.is_number_unsigned() ? limit.get<std::uint64_t>() : 0;
  if (number < atLeast || number > most) {
    throw std::out_of_range(fmt::format("{} is {}, but every device has {} or more", name,
                                        limit.is_number() ? limit.dump() : limit.type_name(), atLeast));
  }
  return static_cast<std::uint32_t>(number);
}

}  // namespace

std::vector<MeasuredDevice> readDevices(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(fmt::format("'{}' cannot be read: {}", file, std::strerror(errno)));
  std::vector<MeasuredDevice> devices;
  const auto fail = [&](const std::exception& error) {
    return std::runtime_error(
        fmt::format("'{}' is not what sk info --json={} writes: {}", file, file, error.what()));
  };
  try {
    const nlohmann::json written = nlohmann::json::parse(in);
    for (const nlohmann::json& device : written.at("devices")) {
      const auto limits = device.find("limits");
      if (limits == device.end() || !limits->contains("draw_buffers")) continue;
      devices.push_back({device.at("name").get<std::string>(),
                         {limitOf(*limits, "draw_buffers", least.drawBuffers),
                          limitOf(*limits, "texture_units", least.textureUnits)}});
    }
  } catch (const nlohmann::json::exception& error) {
    throw fail(error);
  } catch (const std::out_of_range& error) {
    throw fail(error);
  }
  if (devices.empty()) {
    throw std::runtime_error(fmt::format("'{}' has no device that draws; write it where there is one", file));
  }
  return devices;
}

}  // namespace skc::driver
