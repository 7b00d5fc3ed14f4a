// SPDX-License-Identifier: MIT
#include "configuration.hpp"

#include <algorithm>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

#include "sk/error.hpp"

namespace sk {

namespace {

constexpr std::string_view precisions[] = {"half", "single", "extended", "double"};
constexpr std::string_view accumulates[] = {"tree", "compensated", "extended", "exact"};
constexpr std::string_view intrinsics[] = {"fast", "accurate"};

/// The enumerator of a name: they follow Default in this order.
template <class Choice>
Choice choiceOf(std::span<const std::string_view> names, const std::string& file, std::string_view key,
                const toml::node& node) {
  const std::string name = node.value_or(std::string());
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) {
    throw Error(fmt::format("{}:{}: {} is one of \"{}\"", file, node.source().begin.line, key,
                            fmt::join(names, "\", \"")));
  }
  return static_cast<Choice>(found - names.begin() + 1);
}

CallOptions optionsOf(const std::string& file, const toml::table& table) {
  CallOptions options;
  for (const auto& [key, node] : table) {
    if (key == "precision") {
      options.precision = choiceOf<Precision>(precisions, file, "precision", node);
    } else if (key == "accumulate") {
      options.accumulate = choiceOf<Accumulate>(accumulates, file, "accumulate", node);
    } else if (key == "intrinsics") {
      options.intrinsics = choiceOf<Intrinsics>(intrinsics, file, "intrinsics", node);
    } else {
      throw Error(
          fmt::format("{}:{}: there is no choice '{}'; there are precision, accumulate and intrinsics", file,
                      key.source().begin.line, key.str()));
    }
  }
  return options;
}

toml::table parsed(const std::string& file) {
  try {
    return toml::parse_file(file);
  } catch (const toml::parse_error& error) {
    const auto line = error.source().begin.line;
    throw Error(line == 0 ? fmt::format("{} (option or SK_CONFIG): {}", file, error.description())
                          : fmt::format("{}:{}: {}", file, line, error.description()));
  }
}

/// What `first` leaves open is as in `second`.
CallOptions merged(CallOptions first, const CallOptions& second) {
  if (first.accumulate == Accumulate::Default) first.accumulate = second.accumulate;
  if (first.precision == Precision::Default) first.precision = second.precision;
  if (first.intrinsics == Intrinsics::Default) first.intrinsics = second.intrinsics;
  return first;
}

}  // namespace

Configuration::Configuration(const std::string& file) {
  for (const auto& [key, node] : parsed(file)) {
    const toml::table* kernels = node.as_table();
    if (key != "kernels" || kernels == nullptr) {
      throw Error(fmt::format("{}:{}: expected tables like [kernels.\"heat::diffuse\"] or [kernels.\"*\"]",
                              file, key.source().begin.line));
    }
    for (const auto& [name, choices] : *kernels) {
      if (!choices.is_table()) {
        throw Error(fmt::format("{}:{}: expected a table, [kernels.\"{}\"]", file, name.source().begin.line,
                                name.str()));
      }
      kernels_[std::string(name.str())] = optionsOf(file, *choices.as_table());
    }
  }
}

CallOptions Configuration::resolve(const program::Kernel& kernel, const CallOptions& call) const {
  CallOptions options = call;
  for (const std::string_view name : {kernel.name, std::string_view("*")}) {
    if (const auto found = kernels_.find(name); found != kernels_.end())
      options = merged(options, found->second);
  }
  return merged(options, kernel.options);
}

}  // namespace sk
