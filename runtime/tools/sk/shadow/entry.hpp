// SPDX-License-Identifier: MIT
//
// Entries of a report that others wrote: each knows where it stands, so that a damaged report is named by its place.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace sk_tool {

/// A value within a report, which must outlive it. Each function throws std::runtime_error, which names the place, if the value is
/// missing or has another type.
class Entry {
 public:
  explicit Entry(const nlohmann::ordered_json& root) : value_(&root) {}

  bool has(const char* name) const { return value_->is_object() && value_->contains(name); }
  bool isNull() const { return value_->is_null(); }
  /// A member, which may be null.
  Entry operator[](const char* name) const;
  /// An element of a list.
  Entry at(std::size_t index) const;
  /// The number of elements of a list.
  std::size_t size() const;

  /// A number; "nan", "inf" and "-inf" are also numbers.
  double number() const;
  long long integer() const;
  bool flag() const;
  /// A text in one line: control characters, which could write anywhere on a terminal, are spaces.
  std::string text() const;
  /// A number, a text, a list or a list of lists, in one line: 1.5, nan, (1, 2).
  std::string asWritten(int deepest = 2) const;

 private:
  Entry(const nlohmann::ordered_json& value, std::string place) : value_(&value), place_(std::move(place)) {}
  [[noreturn]] void fail(std::string_view why) const;

  const nlohmann::ordered_json* value_;
  std::string place_;  ///< kernels[3].own
};

/// Calls `use` for each element of a list.
template <class Use>
void forEach(const Entry& list, Use use) {
  for (std::size_t i = 0; i < list.size(); ++i) use(list.at(i));
}

}  // namespace sk_tool
