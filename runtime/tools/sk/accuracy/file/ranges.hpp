// SPDX-License-Identifier: MIT
//
// The range of a parameter's scalars, or their values: from the options --range and --set, else what the parameter declares.
//
// Access to the scalars of elements whose type is known only at run time. A double can represent each of
// them.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "accuracy/experiment.hpp"
#include "accuracy/file/kernel_library.hpp"
#include "sk/program.hpp"

namespace sk_tool {

struct ScalarPlace {
  std::string member;  ///< ".position" in a struct, "[2]" in an array, else empty
  std::string component;  ///< ".x" in a vector, "[0].x" in a matrix, else empty
  sk::program::Scalar scalar;
  std::size_t offset;  ///< bytes from the element's start
};

/// Returns the scalars in the order of the element's fields.
std::vector<ScalarPlace> scalarsOf(const sk::program::Element& element);

/// Whether it represents a real number.
bool isReal(sk::program::Scalar scalar);

double load(sk::program::Scalar scalar, const std::byte* from);
/// Stores the nearest value of the type.
void store(sk::program::Scalar scalar, double value, std::byte* to);
/// The nearest value of the type to a real number.
double roundedTo(sk::program::Scalar scalar, double value);
/// The distance between neighbouring numbers of a real type at `value`.
double ulpOf(sk::program::Scalar scalar, double value);
/// The smallest normal number of a real type; errors below it are relative to it.
double smallestOf(sk::program::Scalar scalar);

/// Formats reals in hexadecimal, without rounding.
std::string hexOf(sk::program::Scalar scalar, double value);
/// "value" (null if not finite), "hex", and for floats "bits".
Json jsonOf(sk::program::Scalar scalar, double value);

struct Range {
  double low = 0, high = 0;
  /// The parameter declares it: extremes outside are none.
  std::optional<sk::program::ValueRange> promise = {};

  bool isValue() const { return low == high; }
};

/// What to draw from for a declared range: numbers of the type, up to where an infinite range would begin to be all extremes. Of a spec
/// parameter, the one value next to 1.
std::optional<Range> declaredRange(const sk::program::Parameter& parameter, sk::program::Scalar scalar);

class Ranges {
 public:
  /// Parses "x=-1:1", or for a member "body.mass=1:2". Throws std::runtime_error.
  void addRange(const std::string& text);
  /// Parses "n=3", or one value per scalar: "light=0,1,0".
  void addValues(const std::string& text);

  /// Throws std::runtime_error if no subject has a parameter or member of a given name, or if its number of
  /// scalars differs from the number of values.
  void check(std::span<const Subject> subjects) const;

  /// The range of each scalar of the parameter's element, in order; nullopt where no option applies and none is declared.
  std::vector<std::optional<Range>> of(const sk::program::Parameter& parameter) const;

  /// The options as given, and what the subject's other parameters declare.
  std::string text(const Subject& subject) const;

 private:
  std::map<std::string, std::vector<Range>> byName_;  ///< one for all scalars, or one for each
};

}  // namespace sk_tool
