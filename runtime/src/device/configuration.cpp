// SPDX-License-Identifier: MIT
#include "device/configuration.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "assemble/nearest_word.hpp"
#include "sk/error.hpp"
#include "toml/read_toml.hpp"

namespace sk {

namespace {

constexpr std::string_view precisions[] = {"half", "single", "extended", "double"};
constexpr std::string_view accumulates[] = {"tree", "compensated", "extended", "exact"};
constexpr std::string_view intrinsics[] = {"fast", "accurate"};
constexpr std::string_view storages[] = {"single", "half", "extended", "double"};
constexpr std::string_view tableUses[] = {"off", "on"};
constexpr std::string_view targets[] = {"fragment", "compute", "native"};
constexpr std::string_view contractions[] = {"exact", "fast"};
constexpr std::string_view orders[] = {"kept", "any"};

/// The enumerator of a name: the names are in the enumerators' order, without Default.
template <class Choice>
Choice choiceOf(std::span<const std::string_view> names, const std::string& file, std::string_view key,
                const toml::node& node) {
  const std::string name = node.value_or(std::string());
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) {
    throw Error(fmt::format("{}:{}: {} is one of \"{}\"", file, node.source().begin.line, key,
                            fmt::join(names, "\", \"")),
                Error::Kind::File);
  }
  return static_cast<Choice>(found - names.begin() + 1);
}

/// Sets `isForced` if the table has `force = true`.
CallOptions optionsOf(const std::string& file, const toml::table& table, bool& isForced) {
  CallOptions options;
  for (const auto& [key, node] : table) {
    if (key == "precision") {
      options.precision = choiceOf<Precision>(precisions, file, "precision", node);
    } else if (key == "accumulate") {
      options.accumulate = choiceOf<Accumulate>(accumulates, file, "accumulate", node);
    } else if (key == "intrinsics") {
      options.intrinsics = choiceOf<Intrinsics>(intrinsics, file, "intrinsics", node);
    } else if (key == "tables") {
      options.tables = choiceOf<Tables>(tableUses, file, "tables", node);
    } else if (key == "target") {
      options.target = choiceOf<Target>(targets, file, "target", node);
    } else if (key == "contraction") {
      options.contraction = choiceOf<Contraction>(contractions, file, "contraction", node);
    } else if (key == "order") {
      options.order = choiceOf<Order>(orders, file, "order", node);
    } else if (key == "force") {
      const std::optional<bool> value = node.value_exact<bool>();
      if (!value) {
        throw Error(fmt::format("{}:{}: force is true or false", file, node.source().begin.line),
                    Error::Kind::File);
      }
      isForced = *value;
    } else {
      throw Error(
          fmt::format(
              "{}:{}: there is no choice '{}'; there are precision, accumulate, intrinsics, tables, target, "
              "contraction, order and force",
              file, key.source().begin.line, key.str()),
          Error::Kind::File);
    }
  }
  return options;
}

std::string placeOf(const std::string& file, const toml::key& key) {
  return fmt::format("{}:{}", file, key.source().begin.line);
}

/// A number of the file. Throws unless it is finite.
float numberOf(const std::string& file, const toml::key& key, const toml::node& node) {
  const std::optional<double> value = node.value<double>();
  if (!value || !std::isfinite(static_cast<float>(*value))) {
    throw Error(
        fmt::format("{}:{}: {} is a number of float's range", file, node.source().begin.line, key.str()),
        Error::Kind::File);
  }
  return static_cast<float>(*value);
}

Configuration::RangeChoice rangeOf(const std::string& file, const toml::key& name, const toml::table& table) {
  Configuration::RangeChoice choice{.place = placeOf(file, name)};
  for (const auto& [key, node] : table) {
    if (key == "low") {
      choice.low = numberOf(file, key, node);
    } else if (key == "high") {
      choice.high = numberOf(file, key, node);
    } else if (key == "intervals") {
      const std::int64_t count = node.value_exact<std::int64_t>().value_or(0);
      if (count < 1 || count > mostIntervals) {
        throw Error(fmt::format("{}:{}: intervals is a whole number from 1 to {}", file,
                                node.source().begin.line, mostIntervals),
                    Error::Kind::File);
      }
      choice.intervals = static_cast<std::int32_t>(count);
    } else {
      throw Error(fmt::format("{}:{}: a table has no '{}'; it has low, high and intervals", file,
                              key.source().begin.line, key.str()),
                  Error::Kind::File);
    }
  }
  return choice;
}

Storage storageOf(const std::string& file, const toml::key& name, const toml::table& table) {
  Storage storage = Storage::Default;
  for (const auto& [key, node] : table) {
    if (key != "storage") {
      throw Error(fmt::format("{}:{}: a stream has no '{}'; it has storage", file, key.source().begin.line,
                              key.str()),
                  Error::Kind::File);
    }
    storage = choiceOf<Storage>(storages, file, "storage", node);
  }
  if (storage == Storage::Default) {
    throw Error(fmt::format("{}:{}: expected storage = \"half\" or the like for stream '{}'", file,
                            name.source().begin.line, name.str()),
                Error::Kind::File);
  }
  return storage;
}

/// The value of a constant of a device. Throws unless the row's range has it.
double traitOf(const std::string& file, const gl::DeviceTraitRow& row, const toml::node& node) {
  std::optional<double> value;
  if (row.isBool) {
    if (const std::optional<bool> isOn = node.value_exact<bool>()) value = *isOn ? 1 : 0;
  } else if (row.isWhole) {
    if (const std::optional<std::int64_t> whole = node.value_exact<std::int64_t>())
      value = static_cast<double>(*whole);
  } else {
    value = node.value<double>();
  }
  if (value && *value >= 0 && *value <= row.most) return *value;
  throw Error(fmt::format("{}:{}: {} ({}) is {}", file, node.source().begin.line, row.name, row.meaning,
                          row.isBool ? "true or false"
                                     : fmt::format("a {} from 0 to {}",
                                                   row.isWhole ? "whole number" : "number", row.most)),
              Error::Kind::File);
}

gl::TraitChoices traitsOf(const std::string& file, const toml::table& table) {
  gl::TraitChoices choices;
  for (const auto& [key, node] : table) {
    const auto row = std::ranges::find(gl::deviceTraitRows(), key.str(), &gl::DeviceTraitRow::name);
    if (row == gl::deviceTraitRows().end()) {
      std::vector<std::string> names;
      for (const gl::DeviceTraitRow& known : gl::deviceTraitRows()) names.emplace_back(known.name);
      throw Error(fmt::format("{}:{}: a device has no '{}'; it has {}", file, key.source().begin.line,
                              key.str(), fmt::join(names, ", ")),
                  Error::Kind::File);
    }
    row->choose(choices, traitOf(file, *row, node));
  }
  return choices;
}

toml::table parsed(const std::string& file) {
  try {
    return readToml(file);
  } catch (const toml::parse_error& error) {
    const auto line = error.source().begin.line;
    throw Error(line == 0 ? fmt::format("{} (option or SK_CONFIG): {}", file, error.description())
                          : fmt::format("{}:{}: {}", file, line, error.description()),
                Error::Kind::File);
  }
}

/// Replaces the defaults in `first` by the choices of `second`.
CallOptions merged(CallOptions first, const CallOptions& second) {
  if (first.accumulate == Accumulate::Default) first.accumulate = second.accumulate;
  if (first.precision == Precision::Default) first.precision = second.precision;
  if (first.intrinsics == Intrinsics::Default) first.intrinsics = second.intrinsics;
  if (first.tables == Tables::Default) first.tables = second.tables;
  if (first.target == Target::Default) first.target = second.target;
  if (first.contraction == Contraction::Default) first.contraction = second.contraction;
  if (first.order == Order::Default) first.order = second.order;
  return first;
}

/// The options, with the choices of `forced` in the place of theirs. Choices that these exclude become Default.
CallOptions withForced(CallOptions options, const CallOptions& forced) {
  if (forced.precision != Precision::Default && forced.precision != Precision::Single) {
    const bool isOfFloats =
        options.accumulate == Accumulate::Exact || options.accumulate == Accumulate::Compensated;
    if (isOfFloats) options.accumulate = Accumulate::Default;
    if (options.tables == Tables::On) options.tables = Tables::Default;
  }
  const bool needsFloats = forced.accumulate == Accumulate::Exact ||
                           forced.accumulate == Accumulate::Compensated || forced.tables == Tables::On;
  if (needsFloats) options.precision = Precision::Default;
  return options.with(forced);
}

/// The namespaces of a qualified name, and the rest.
std::pair<std::string_view, std::string_view> qualifierAndName(std::string_view qualified) {
  const std::size_t end = qualified.rfind("::");
  if (end == std::string_view::npos) return {{}, qualified};
  return {qualified.substr(0, end), qualified.substr(end + 2)};
}

/// The linked name that was probably meant by an unknown one: it differs by little, in the namespaces alone or
/// in the rest alone, or the namespaces were left out. "" if there is none.
std::string_view linkedNameLike(std::string_view unknown, std::span<const std::string> linked) {
  const auto [qualifier, name] = qualifierAndName(unknown);
  if (qualifier.empty()) {
    for (const std::string& other : linked) {
      if (qualifierAndName(other).second == name) return other;
    }
  }
  const std::string_view nearest = assemble::nearestWord(unknown, linked);
  const auto [nearestQualifier, nearestName] = qualifierAndName(nearest);
  return nearestQualifier == qualifier || nearestName == name ? nearest : std::string_view();
}

}  // namespace

Configuration::Configuration(const std::string& file) {
  for (const auto& [key, node] : parsed(file)) {
    const toml::table* named = node.as_table();
    const bool isKnown = key == "kernels" || key == "tables" || key == "streams" || key == "devices";
    if (!isKnown || named == nullptr) {
      throw Error(fmt::format("{}:{}: expected tables like [kernels.\"heat::diffuse\"], [kernels.\"*\"], "
                              "[tables.\"heat::response\"], [streams.\"heat::u\"] or [devices.\"llvmpipe\"]",
                              file, key.source().begin.line),
                  Error::Kind::File);
    }
    for (const auto& [name, choices] : *named) {
      if (key == "devices" && name.str().empty()) {
        throw Error(fmt::format("{}:{}: expected a part of a renderer's name, or \"*\" for all", file,
                                name.source().begin.line),
                    Error::Kind::File);
      }
      if (!choices.is_table()) {
        throw Error(fmt::format("{}:{}: expected a table, [{}.\"{}\"]", file, name.source().begin.line,
                                key.str(), name.str()),
                    Error::Kind::File);
      }
      if (key == "kernels") {
        KernelChoice& choice = kernels_[std::string(name.str())];
        choice.options = optionsOf(file, *choices.as_table(), choice.isForced);
        choice.place = placeOf(file, name);
      } else if (key == "streams") {
        streams_[std::string(name.str())] = sk::storageOf(file, name, *choices.as_table());
      } else if (key == "devices") {
        devices_[gl::lowerCase(name.str())] = sk::traitsOf(file, *choices.as_table());
      } else {
        tables_[std::string(name.str())] = sk::rangeOf(file, name, *choices.as_table());
      }
    }
  }
}

void Configuration::checkNames(const program::LinkedFile::Names& linked) const {
  const auto check = [](std::string_view what, const auto& choices, std::span<const std::string> known) {
    for (const auto& [name, choice] : choices) {
      if (name == "*" || std::ranges::find(known, name) != known.end()) continue;
      const std::string_view meant = linkedNameLike(name, known);
      if (meant.empty()) continue;
      throw Error(
          fmt::format("{}: the program has no {} '{}'; did you mean '{}'?", choice.place, what, name, meant),
          Error::Kind::File);
    }
  };
  check("kernel", kernels_, linked.kernels);
  check("table of", tables_, linked.tables);
}

Storage Configuration::storageOf(std::string_view stream) const {
  for (const std::string_view name : {stream, std::string_view("*")}) {
    if (const auto found = streams_.find(name); found != streams_.end()) return found->second;
  }
  return Storage::Single;
}

gl::TraitChoices Configuration::traitsOf(std::string_view renderer) const {
  const std::string name = gl::lowerCase(renderer);
  gl::TraitChoices choices;
  for (const auto& [part, chosen] : devices_) {
    if (part != "*" && name.find(part) != std::string::npos) choices = choices.over(chosen);
  }
  const auto all = devices_.find("*");
  return all == devices_.end() ? choices : choices.over(all->second);
}

TableRange Configuration::rangeOf(const program::Table& table) const {
  TableRange range = table.range;
  const auto found = tables_.find(table.function);
  if (found == tables_.end()) return range;
  const RangeChoice& choice = found->second;
  range = {choice.low.value_or(range.low), choice.high.value_or(range.high),
           choice.intervals.value_or(range.intervals)};
  if (!(range.low < range.high)) {
    throw Error(
        fmt::format("{}: the table of '{}' begins at {} and ends at {}; say low and high so that low is less",
                    choice.place, table.function, range.low, range.high),
        Error::Kind::File);
  }
  return range;
}

CallOptions Configuration::resolve(const program::Kernel& kernel, const CallOptions& call) const {
  if (kernels_.empty()) return merged(call, kernel.options);
  CallOptions forced, unforced = call;
  for (const std::string_view name : {kernel.name, std::string_view("*")}) {
    const auto found = kernels_.find(name);
    if (found == kernels_.end()) continue;
    CallOptions& options = found->second.isForced ? forced : unforced;
    options = merged(options, found->second.options);
  }
  return withForced(merged(unforced, kernel.options), forced);
}

std::vector<std::string> choicesOf(const CallOptions& options) {
  std::vector<std::string> choices;
  const auto add = [&](std::string_view key, std::span<const std::string_view> names, auto choice) {
    const auto number = static_cast<std::size_t>(choice);
    if (number != 0) choices.push_back(fmt::format("{} {}", key, names[number - 1]));
  };
  add("precision", precisions, options.precision);
  add("accumulate", accumulates, options.accumulate);
  add("intrinsics", intrinsics, options.intrinsics);
  add("tables", tableUses, options.tables);
  add("target", targets, options.target);
  add("contraction", contractions, options.contraction);
  add("order", orders, options.order);
  return choices;
}

std::string_view nameOf(Storage storage) {
  return storage == Storage::Default ? "default" : storages[static_cast<std::size_t>(storage) - 1];
}

}  // namespace sk
