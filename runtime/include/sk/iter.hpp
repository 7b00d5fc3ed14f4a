// SPDX-License-Identifier: MIT
//
// The argument of an `iter` parameter: the two ends of an arithmetic ramp over the domain.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "sk/shape.hpp"
#include "sk/types.hpp"

namespace sk {

/// float, int or uint, or a vector of them.
template <class T>
concept IterableType = ElementType<T> && requires {
  requires ElementTraits<T>::value.fields.size() == 1;
  requires ElementTraits<T>::value.fields[0].path.empty();
  requires ElementTraits<T>::value.fields[0].scalar != program::Scalar::Bool;
};

/// A ramp over the domain. The first element is `ends[0]`; `ends[1]` is one step after the last element.
/// Created by iter().
template <IterableType T>
struct Iter {
  T ends[2];
  Shape shape = {};  ///< shape of the domain; rank 0: any
};

/// The ramp from `begin` (inclusive) to `end` (exclusive) in as many equal steps as the domain has
/// elements: sk::iter(0, 100) is 0, 1, ... 99 over 100 elements.
///
/// A scalar runs over all elements, row-major. A vector has one component for each dimension of the domain,
/// with x along the last extent; in a one-dimensional domain, all components run along that dimension.
///
/// Element k of n is begin + k * step with step = (end - begin) / n, computed in double precision and rounded
/// once. Integers take whole steps: a call throws sk::Error unless n divides end - begin. It also throws
/// unless the number of components matches the domain's dimensions.
template <IterableType T>
Iter<T> iter(const T& begin, const std::type_identity_t<T>& end) {
  return {{begin, end}, {}};
}

/// A ramp over a domain of this shape, rows first; a call over a domain of another shape throws sk::Error. A
/// kernel without element outputs takes its domain from the ramp.
template <IterableType T>
Iter<T> iter(const T& begin, const std::type_identity_t<T>& end, const Shape& shape) {
  return {{begin, end}, shape};
}

}  // namespace sk
