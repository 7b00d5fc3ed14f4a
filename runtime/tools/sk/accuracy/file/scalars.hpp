// SPDX-License-Identifier: MIT
//
// Elements whose type is known at run time, as the scalars that they are made of, each of which a double can hold.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "accuracy/experiment.hpp"
#include "sk/program.hpp"

namespace sk_tool {

struct ScalarPlace {
  std::string member;  ///< ".position" of a struct, "[2]" of an array, else empty
  std::string component;  ///< ".x" of a vector, "[0].x" of a matrix, else empty
  sk::program::Scalar scalar;
  std::size_t offset;  ///< bytes from the element's start
};

/// In the order of the element's fields.
std::vector<ScalarPlace> scalarsOf(const sk::program::Element& element);

/// Whether it stands for a real number.
bool isReal(sk::program::Scalar scalar);

double load(sk::program::Scalar scalar, const std::byte* from);
/// The nearest that the type has.
void store(sk::program::Scalar scalar, double value, std::byte* to);
/// What is left of a real number in the type.
double roundedTo(sk::program::Scalar scalar, double value);
/// The distance between numbers of a real type around `value`.
double ulpOf(sk::program::Scalar scalar, double value);
/// The smallest normal number of a real type: below it, errors are relative to this.
double smallestOf(sk::program::Scalar scalar);

/// Reals in hexadecimal, which loses no bit.
std::string hexOf(sk::program::Scalar scalar, double value);
/// "value" (null where it is no number), "hex", and of a float its "bits".
Json jsonOf(sk::program::Scalar scalar, double value);

}  // namespace sk_tool
