// SPDX-License-Identifier: MIT
//
// What an `iter` parameter of a kernel takes: the two ends of an arithmetic ramp over the domain.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "sk/shape.hpp"
#include "sk/types.hpp"

namespace sk {

/// A float, int or uint, or a vector of them.
template <class T>
concept IterableType = ElementType<T> && requires {
  requires ElementTraits<T>::value.fields.size() == 1;
  requires ElementTraits<T>::value.fields[0].path.empty();
  requires ElementTraits<T>::value.fields[0].scalar != program::Scalar::Bool;
};

/// A ramp from `ends[0]` at the first element towards `ends[1]`, which the element after the last
/// would have. Made by iter().
template <IterableType T>
struct Iter {
  T ends[2];
  Shape shape = {};   ///< of the domain, or of rank 0: any
};

/// The ramp from `begin` (inclusive) to `end` (exclusive) in as many equal steps as the domain has
/// elements: sk::iter(0, 100) is 0, 1, ... 99 over 100 elements.
///
/// A scalar runs over all elements, row-major. A vector has one component for each dimension of the
/// domain, x running along the last extent; in a domain of one dimension all components run along it.
///
/// Element k of n is begin + k * step with step = (end - begin) / n, which is computed in double
/// precision and rounded once. Integers take whole steps: n must divide end - begin. A call throws
/// sk::Error where it does not, or where the components are not as many as the dimensions.
template <IterableType T>
Iter<T> iter(const T& begin, const std::type_identity_t<T>& end) {
  return {{begin, end}, {}};
}

/// The same over a domain of this shape, rows first; a call over another throws sk::Error. A kernel
/// without element outputs takes its domain from it.
template <IterableType T>
Iter<T> iter(const T& begin, const std::type_identity_t<T>& end, const Shape& shape) {
  return {{begin, end}, shape};
}

}  // namespace sk
