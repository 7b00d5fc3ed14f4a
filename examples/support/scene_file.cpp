// SPDX-License-Identifier: MIT
#include "support/scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "toml/read_toml.hpp"

namespace examples {

struct SceneTable::Document {
  std::string name;
  toml::table root;
  std::map<const void*, std::set<std::string, std::less<>>> asked;  ///< of each table
};

namespace {

using Names = std::set<std::string, std::less<>>;

[[noreturn]] void failAt(const std::string& file, const toml::source_position& place,
                         std::string_view message) {
  throw std::runtime_error(fmt::format("{}:{}:{}: {}", file, place.line, place.column, message));
}

/// Insertions, deletions and replacements that make one name the other (V. Levenshtein, 1966).
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// What may be written instead of a key that nobody knows.
std::string hint(std::string_view key, const Names& known) {
  if (known.empty()) return "nothing may stand here";
  const auto nearest =
      std::ranges::min_element(known, {}, [&](const std::string& name) { return distance(key, name); });
  if (distance(key, *nearest) <= 1 + nearest->size() / 4) return fmt::format("did you mean '{}'?", *nearest);
  return fmt::format("there are {}", fmt::join(known, ", "));
}

std::string_view wordFor(toml::node_type type) {
  switch (type) {
    case toml::node_type::none: return "nothing";
    case toml::node_type::table: return "a table";
    case toml::node_type::array: return "an array";
    case toml::node_type::string: return "a text";
    case toml::node_type::integer: return "an integer";
    case toml::node_type::floating_point: return "a number";
    case toml::node_type::boolean: return "true or false";
    case toml::node_type::date: return "a date";
    case toml::node_type::time: return "a time";
    case toml::node_type::date_time: return "a date and time";
  }
  return "something else";
}

void checkKnown(const std::string& file, const toml::table& table,
                const std::map<const void*, Names>& asked) {
  static const Names none;
  const auto found = asked.find(&table);
  const Names& known = found == asked.end() ? none : found->second;
  for (const auto& [key, node] : table) {
    if (!known.contains(key.str())) {
      failAt(file, key.source().begin,
             fmt::format("nobody knows '{}' here; {}", key.str(), hint(key.str(), known)));
    }
    if (const toml::table* below = node.as_table()) checkKnown(file, *below, asked);
    if (const toml::array* list = node.as_array()) {
      for (const toml::node& element : *list) {
        if (const toml::table* below = element.as_table()) checkKnown(file, *below, asked);
      }
    }
  }
}

}  // namespace

static_assert(static_cast<int>(sk::Precision::Half) == 1 && static_cast<int>(sk::Precision::Double) == 4);

sk::Precision precisionNamed(std::string_view name) {
  return static_cast<sk::Precision>(1 + (std::ranges::find(precisionNames, name) - precisionNames.begin()));
}

std::string_view nameOf(sk::Precision precision) {
  return precision == sk::Precision::Default ? "single"
                                             : precisionNames[static_cast<std::size_t>(precision) - 1];
}

struct SceneTable::Access {
  const SceneTable& of;
  std::string_view key;

  const toml::table& table() const { return *static_cast<const toml::table*>(of.table_); }
  const toml::node* find() const {
    of.document_->asked[of.table_].emplace(key);
    return table().get(key);
  }
  [[noreturn]] void fail(const toml::node& node, std::string_view message) const {
    failAt(of.document_->name, node.source().begin, message);
  }
  [[noreturn]] void failType(const toml::node& node, std::string_view wanted) const {
    fail(node, fmt::format("'{}' is {} here, but must be {}", key, wordFor(node.type()), wanted));
  }
  double number(const toml::node& node, const Range& range) const {
    const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value) failType(node, "a number");
    if (!std::isfinite(*value)) fail(node, fmt::format("'{}' is {}, but must be finite", key, *value));
    checkRange(node, *value, range);
    return *value;
  }
  void checkRange(const toml::node& node, double value, const Range& range) const {
    if (value >= range.least && value <= range.most) return;
    const Range all;
    fail(node, range.most == all.most
                   ? fmt::format("'{}' is {:.9g}, but must be {:.9g} at least", key, value, range.least)
               : range.least == all.least
                   ? fmt::format("'{}' is {:.9g}, but must be {:.9g} at most", key, value, range.most)
                   : fmt::format("'{}' is {:.9g}, but must be from {:.9g} to {:.9g}", key, value, range.least,
                                 range.most));
  }
};

bool SceneTable::has(std::string_view key) const { return Access{*this, key}.find() != nullptr; }

std::optional<SceneTable> SceneTable::table(std::string_view key) const {
  const Access access{*this, key};
  const toml::node* node = access.find();
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) access.failType(*node, fmt::format("a table, [{}]", key));
  return SceneTable(document_, node->as_table());
}

std::vector<SceneTable> SceneTable::tables(std::string_view key) const {
  const Access access{*this, key};
  const toml::node* node = access.find();
  std::vector<SceneTable> list;
  if (node == nullptr) return list;
  const toml::array* array = node->as_array();
  if (array == nullptr) access.failType(*node, fmt::format("a list of tables, each [[{}]]", key));
  for (const toml::node& element : *array) {
    if (!element.is_table()) access.failType(element, fmt::format("a list of tables, each [[{}]]", key));
    list.push_back(SceneTable(document_, element.as_table()));
  }
  return list;
}

std::optional<double> SceneTable::number(std::string_view key, const Range& range) const {
  const Access access{*this, key};
  const toml::node* node = access.find();
  if (node == nullptr) return std::nullopt;
  return access.number(*node, range);
}

std::optional<std::int64_t> SceneTable::integer(std::string_view key, const Range& range) const {
  const Access access{*this, key};
  const toml::node* node = access.find();
  if (node == nullptr) return std::nullopt;
  const std::optional<std::int64_t> value = node->value_exact<std::int64_t>();
  if (!value) access.failType(*node, "an integer");
  access.checkRange(*node, static_cast<double>(*value), range);
  return value;
}

std::optional<bool> SceneTable::flag(std::string_view key) const {
  const Access access{*this, key};
  const toml::node* node = access.find();
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean()) access.failType(*node, "true or false");
  return node->value<bool>();
}

std::optional<std::string> SceneTable::text(std::string_view key) const {
  const Access access{*this, key};
  const toml::node* node = access.find();
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) access.failType(*node, "a text, \"in quotes\"");
  return node->value<std::string>();
}

std::optional<std::vector<double>> SceneTable::numbers(std::string_view key, int count,
                                                       const Range& range) const {
  const Access access{*this, key};
  const toml::node* node = access.find();
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  const std::string wanted = count < 0 ? "an array of numbers" : fmt::format("an array of {} numbers", count);
  if (array == nullptr) access.failType(*node, wanted);
  if (count >= 0 && array->size() != static_cast<std::size_t>(count)) {
    access.fail(*node, fmt::format("'{}' has {} elements, but must be {}", key, array->size(), wanted));
  }
  std::vector<double> values;
  for (const toml::node& element : *array) values.push_back(access.number(element, range));
  return values;
}

std::optional<std::size_t> SceneTable::choice(std::string_view key,
                                              std::span<const std::string_view> names) const {
  const std::optional<std::string> name = text(key);
  if (!name) return std::nullopt;
  const auto found = std::ranges::find(names, std::string_view(*name));
  if (found == names.end()) {
    fail(key,
         fmt::format("there is no {} '{}'; {}", key, *name, hint(*name, Names(names.begin(), names.end()))));
  }
  return static_cast<std::size_t>(found - names.begin());
}

std::optional<Vector> SceneTable::vector(std::string_view key) const {
  const auto v = numbers(key, 3, Range{-1e30, 1e30});
  return v ? std::optional(Vector{(*v)[0], (*v)[1], (*v)[2]}) : std::nullopt;
}

std::optional<Vector> SceneTable::direction(std::string_view key) const {
  const auto v = vector(key);
  if (v && !(length(*v) > 0)) refuse(key, "is a direction and cannot be zero");
  return v ? std::optional(normalized(*v)) : std::nullopt;
}

std::optional<sk::Precision> SceneTable::precision(std::string_view key,
                                                   std::span<const std::string_view> names) const {
  const auto number = choice(key, names);
  return number ? std::optional(precisionNamed(names[*number])) : std::nullopt;
}

void SceneTable::fail(std::string_view key, std::string_view message) const {
  const Access access{*this, key};
  const toml::node* node = access.find();
  failAt(document_->name, node != nullptr ? node->source().begin : access.table().source().begin, message);
}

void SceneTable::refuse(std::string_view key, std::string_view what) const {
  fail(key, fmt::format("'{}' {}", key, what));
}

void SceneTable::finish() const { checkKnown(document_->name, Access{*this, {}}.table(), document_->asked); }

SceneTable loadScene(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw std::runtime_error(fmt::format("the scene '{}' does not exist", name));
  }
  try {
    auto document = std::make_shared<SceneTable::Document>();
    document->name = name;
    document->root = sk::readToml(name);
    const toml::table* root = &document->root;
    return SceneTable(std::move(document), root);
  } catch (const toml::parse_error& error) {
    if (error.source().begin.line == 0)
      throw std::runtime_error(fmt::format("the scene '{}' cannot be read; name a TOML file", name));
    failAt(name, error.source().begin, error.description());
  }
}

}  // namespace examples
