// SPDX-License-Identifier: MIT
//
// The options --range and --set: the range of a parameter's scalars, or their values.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "accuracy/file/kernel_library.hpp"
#include "accuracy/file/scalars.hpp"

namespace sk_tool {

struct Range {
  double low = 0, high = 0;

  bool isValue() const { return low == high; }
};

class Ranges {
 public:
  /// Parses "x=-1:1", or for a member "body.mass=1:2". Throws std::runtime_error.
  void addRange(const std::string& text);
  /// Parses "n=3", or one value per scalar: "light=0,1,0".
  void addValues(const std::string& text);

  /// Throws std::runtime_error if no subject has a parameter or member of a given name, or if its number of
  /// scalars differs from the number of values.
  void check(std::span<const Subject> subjects) const;

  /// The range of each scalar of the parameter's element, in order; nullopt where no option applies.
  std::vector<std::optional<Range>> of(const sk::program::Parameter& parameter) const;

  /// The options as given.
  std::string text() const;

 private:
  std::map<std::string, std::vector<Range>> byName_;  ///< one for all scalars, or one for each
};

}  // namespace sk_tool
