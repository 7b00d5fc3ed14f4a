// SPDX-License-Identifier: MIT
#include "shadow/options.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "assemble/nearest_word.hpp"
#include "sk/error.hpp"

namespace sk::shadow {

namespace {

[[noreturn]] void refuse(std::string_view option, std::string_view value, std::string_view wanted) {
  throw Error(fmt::format("SK_SHADOW: {} is '{}'; give {}", option, value, wanted));
}

std::int64_t positive(std::string_view option, std::string_view value, std::string_view wanted) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size() || number < 1) refuse(option, value, wanted);
  return number;
}

/// A number of bytes, with a K, M or G for powers of 1024.
std::int64_t bytes(std::string_view value) {
  constexpr std::string_view wanted = "a number of bytes such as 512M or 8G";
  std::int64_t unit = 1;
  std::string_view digits = value;
  if (!digits.empty()) {
    const auto at = std::string_view("KMG").find(digits.back());
    if (at != std::string_view::npos) {
      unit = std::int64_t{1024} << (10 * at);
      digits.remove_suffix(1);
    }
  }
  const std::int64_t number = positive("memory", digits, wanted);
  if (number > INT64_MAX / unit) refuse("memory", value, wanted);
  return number * unit;
}

/// KERNEL.PARAMETER:NUMBER, or KERNEL.PARAMETER[ELEMENT]:NUMBER.
Setting settingOf(std::string_view value) {
  constexpr std::string_view wanted =
      "KERNEL.PARAMETER:NUMBER, as in heat::step.dt:0.5 or heat::step.u[7]:nan";
  const std::size_t dot = value.find('.'), colon = value.rfind(':');
  if (dot == std::string_view::npos || dot == 0 || colon == std::string_view::npos || colon < dot)
    refuse("set", value, wanted);
  Setting setting;
  setting.kernel = value.substr(0, dot);
  std::string_view parameter = value.substr(dot + 1, colon - dot - 1);
  const std::size_t bracket = parameter.find('[');
  if (bracket != std::string_view::npos) {
    const std::string_view digits = parameter.substr(bracket + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), setting.element);
    if (error != std::errc() || std::string_view(end, digits.data() + digits.size()) != "]" ||
        setting.element < 0)
      refuse("set", value, wanted);
    parameter = parameter.substr(0, bracket);
  }
  setting.parameter = parameter;
  const std::string_view number = value.substr(colon + 1);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), setting.value);
  if (error != std::errc() || end != number.data() + number.size() || parameter.empty())
    refuse("set", value, wanted);
  return setting;
}

void set(Options& options, std::string_view name, std::string_view value) {
  if (name == "every") {
    options.every = positive(name, value, "a number of calls from 1 on");
  } else if (name == "kernels" || name == "quad") {
    if (value.empty()) refuse(name, value, "the name of a kernel such as heat::diffuse, or heat::*");
    (name == "quad" ? options.quad : options.kernels).emplace_back(value);
  } else if (name == "decisions") {
    if (value != "own" && value != "follow") refuse(name, value, "own or follow");
    options.followsDecisions = value == "follow";
  } else if (name == "memory") {
    options.memory = bytes(value);
  } else if (name == "given") {
    if (value != "list") refuse(name, value, "list");
    options.listsGiven = true;
  } else if (name == "set") {
    options.settings.push_back(settingOf(value));
  } else if (name == "inputs") {
    if (!value.ends_with(".npz")) refuse(name, value, "a file whose name ends in .npz");
    options.inputs = value;
  } else {
    const std::vector<std::string> known = {"every", "kernels", "decisions", "memory",
                                            "quad",  "inputs",  "given",     "set"};
    const std::string_view near = assemble::nearestWord(name, known);
    throw Error(fmt::format("SK_SHADOW: there is no option '{}'{}; choose one of {}", name,
                            near.empty() ? "" : fmt::format("; did you mean '{}'?", near),
                            fmt::join(known, ", ")));
  }
}

}  // namespace

std::string Options::json() const {
  const std::size_t dot = report.rfind('.'), slash = report.rfind('/');
  const bool hasEnding = dot != std::string::npos && (slash == std::string::npos || dot > slash);
  return (hasEnding ? report.substr(0, dot) : report) + ".json";
}

std::string asOption(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == ',' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

Options parseOptions(std::string_view text) {
  Options options;
  const auto next =
      [&] {  // up to the next comma; a backslash before a comma or a backslash makes it part of a name
        std::string part;
        std::size_t i = 0;
        for (; i < text.size() && text[i] != ','; ++i) {
          const char after = i + 1 < text.size() ? text[i + 1] : '\0';
          if (text[i] == '\\' && (after == ',' || after == '\\')) ++i;
          part += text[i];
        }
        text.remove_prefix(std::min(i + 1, text.size()));
        return part;
      };
  options.report = next();
  if (!options.report.ends_with(".html") && !options.report.ends_with(".json")) {
    throw Error(
        fmt::format("SK_SHADOW: the report is '{}'; give a file whose name ends in .html, "
                    "SK_SHADOW=report.html",
                    options.report));
  }
  while (!text.empty()) {
    const std::string word = next();
    const std::string_view part = word;
    const std::size_t equals = part.find('=');
    set(options, part.substr(0, equals),
        equals == std::string_view::npos ? std::string_view{} : part.substr(equals + 1));
  }
  return options;
}

namespace {

bool matches(std::string_view pattern, std::string_view name) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == name;
  if (!name.starts_with(pattern.substr(0, star))) return false;
  pattern.remove_prefix(star + 1);
  for (std::size_t at = star; at <= name.size(); ++at) {
    if (matches(pattern, name.substr(at))) return true;
  }
  return false;
}

}  // namespace

bool matchesAny(const std::vector<std::string>& patterns, std::string_view name) {
  return std::ranges::any_of(patterns, [&](const std::string& pattern) { return matches(pattern, name); });
}

}  // namespace sk::shadow
