// SPDX-License-Identifier: MIT
//
// What --range and --set say of parameters: where their scalars are drawn from, or what they are.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "accuracy/file/scalars.hpp"
#include "accuracy/file/subject.hpp"

namespace sk_tool {

struct Range {
  double low = 0, high = 0;

  bool isValue() const { return low == high; }
};

class Ranges {
 public:
  /// "x=-1:1", also of a member: "body.mass=1:2". Throws std::runtime_error.
  void addRange(const std::string& text);
  /// "n=3", or a value for each scalar: "light=0,1,0".
  void addValues(const std::string& text);

  /// Throws std::runtime_error where none of the subjects has a parameter or member that is named, or as many scalars as
  /// there are values.
  void check(std::span<const Subject> subjects) const;

  /// Of each scalar of the parameter's element, in order; none where nothing is said.
  std::vector<std::optional<Range>> of(const sk::program::Parameter& parameter) const;

  /// As the options said it.
  std::string text() const;

 private:
  std::map<std::string, std::vector<Range>> byName_;  ///< one for all scalars, or one for each
};

}  // namespace sk_tool
