// SPDX-License-Identifier: MIT
#include "shadow/entry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace sk_tool {

Entry Entry::operator[](const char* name) const {
  if (!value_->is_object()) fail("is no object");
  const auto found = value_->find(name);
  const std::string place = place_.empty() ? name : place_ + "." + name;
  if (found == value_->end()) throw std::runtime_error(fmt::format("'{}' is missing", place));
  return Entry(*found, place);
}

Entry Entry::at(std::size_t index) const {
  if (index >= size()) fail(fmt::format("has no element {}", index));
  return Entry((*value_)[index], fmt::format("{}[{}]", place_, index));
}

std::size_t Entry::size() const {
  if (!value_->is_array()) fail("is no list");
  return value_->size();
}

double Entry::number() const {
  if (value_->is_number()) return value_->get<double>();
  if (*value_ == "nan") return std::nan("");
  if (*value_ == "inf") return std::numeric_limits<double>::infinity();
  if (*value_ == "-inf") return -std::numeric_limits<double>::infinity();
  fail("is no number");
}

long long Entry::integer() const {
  if (!value_->is_number_integer()) fail("is no integer");
  return value_->get<long long>();
}

bool Entry::flag() const {
  if (!value_->is_boolean()) fail("is neither true nor false");
  return value_->get<bool>();
}

std::string Entry::text() const {
  if (!value_->is_string()) fail("is no text");
  std::string text = value_->get<std::string>();
  std::ranges::replace_if(text, [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
  return text;
}

std::string Entry::asWritten(int deepest) const {
  if (value_->is_string()) return text();
  if (value_->is_number_float()) return fmt::format("{}", value_->get<double>());
  if (value_->is_number() || value_->is_boolean()) return value_->dump();
  if (deepest == 0) fail("is no value");
  std::string all;
  for (std::size_t i = 0; i < size(); ++i) all += (i > 0 ? ", " : "") + at(i).asWritten(deepest - 1);
  return "(" + all + ")";
}

void Entry::fail(std::string_view why) const {
  throw std::runtime_error(place_.empty() ? fmt::format("it {}", why) : fmt::format("'{}' {}", place_, why));
}

}  // namespace sk_tool
