// SPDX-License-Identifier: MIT
//
// Placed streams: parts of a whole that no single device holds. A kernel that gets them speaks of the whole: its domain,
// the box of a call, indexof, extentof, iterators, the indices of gathers, and boundary modes. The runtime finds the
// elements in the part.
#pragma once

#include <type_traits>

#include "sk/stream.hpp"

namespace sk {

/// A stream or view with its place in a whole, as an argument of a kernel. It is a reference: it must not outlive the
/// stream.
template <class T>
class Placed {
 public:
  using value_type = std::remove_const_t<T>;

  explicit Placed(const StreamRegion& region) : region_(region) {}
  const StreamRegion& region() const { return region_; }

 private:
  StreamRegion region_;
};

/// Says that the elements of `stream` are a part of a larger whole, for example the elements of one rank with a halo
/// around them: the element at index i has index placement.origin + i in the whole. A gather with [[wrap]] may hold
/// elements beyond an end of the whole, which stand for those at the other end.
///
/// All element outputs and element inputs of a call have the whole's shape, or extent 1 where an input repeats. The call
/// computes a box of the whole (CallOptions::box), of which every output and input holds all elements. Gathers hold what
/// the kernel reads for the box: skc finds out how far it reads, or [[halo(n)]] promises it. Streams that are not placed
/// are ordinary arguments. Such a call throws sk::Error if elements are missing, or if it pushes or scatters.
///
/// Throws sk::Error unless the placement has the stream's rank, an extent of the whole is at most mostExtent
/// (sk/limits.hpp), and the part has an element of the whole.
template <ElementType T>
Placed<T> placed(Stream<T>& stream, const Placement& placement) {
  return Placed<T>(detail::placed(stream.region(), placement));
}
template <ElementType T>
Placed<const T> placed(const Stream<T>& stream, const Placement& placement) {
  return Placed<const T>(detail::placed(stream.region(), placement));
}
template <class T>
Placed<T> placed(const View<T>& view, const Placement& placement) {
  return Placed<T>(detail::placed(view.region(), placement));
}

template <class T>
StreamRegion regionOf(const Placed<T>& stream) {
  return stream.region();
}

template <class T>
inline constexpr bool isWritable<Placed<T>> = !std::is_const_v<T>;
template <class T>
inline constexpr bool isWritable<const Placed<T>> = !std::is_const_v<T>;

}  // namespace sk
