// SPDX-License-Identifier: MIT
#include "accuracy/file/options.hpp"

#include <CLI/CLI.hpp>

namespace sk_tool {

void FileOptions::addTo(CLI::App& command) {
  const auto add = [&command](const char* name, auto& variable, const char* help, const char* type) {
    return command.add_option(name, variable, help)->type_name(type)->group("Options for a .sk file");
  };
  add("--kernel", kernel, "Only this kernel or reduce", "NAME");
  add("--range", ranges,
      "Draw a parameter, or a member of it, from here: half of the numbers evenly, the other half with as "
      "many between 1 and 2 as between 100 and 200 (default: reals from [-1, 1] and, of either sign, 1e-4 to "
      "1e4; int -8 to 8, uint "
      "0 to 8)",
      "PARAM=LO:HI")
      ->allow_extra_args(false);
  add("--set", values, "Give a parameter, or a member, this value (default of spec parameters: 1)",
      "PARAM=V[,V...]")
      ->allow_extra_args(false);
  command
      .add_flag(
          "--no-extremes", hasNoExtremes,
          "Leave out inputs like NaN, infinity, denormals, the largest float and the ends of ranges, where a "
          "kernel might never end")
      ->group("Options for a .sk file");
  add("-I", build.includes, "Look for #include files in this directory", "DIR")->allow_extra_args(false);
  add("-D", build.definitions, "Define a macro", "NAME[=VALUE]")->allow_extra_args(false);
  add("--skc", build.skc, "The compiler skc (default: SK_SKC, the one beside sk, the one on PATH)", "FILE");
}

FileMeasurement FileOptions::measurement(const std::vector<std::int64_t>& extents, int rounds) const {
  FileMeasurement measurement{
      .kernel = kernel, .extents = extents, .rounds = rounds, .hasExtremes = !hasNoExtremes};
  for (const std::string& range : ranges) measurement.ranges.addRange(range);
  for (const std::string& value : values) measurement.ranges.addValues(value);
  return measurement;
}

std::string_view FileOptions::used() const {
  if (!kernel.empty()) return "--kernel";
  if (!ranges.empty()) return "--range";
  if (!values.empty()) return "--set";
  if (hasNoExtremes) return "--no-extremes";
  if (!build.includes.empty()) return "-I";
  if (!build.definitions.empty()) return "-D";
  return build.skc.empty() ? "" : "--skc";
}

}  // namespace sk_tool
