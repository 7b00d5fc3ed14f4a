// SPDX-License-Identifier: MIT
//
// Access to the scalars of elements whose type is known only at run time. A double can represent each of
// them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "accuracy/experiment.hpp"
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

}  // namespace sk_tool
