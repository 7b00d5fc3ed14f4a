// SPDX-License-Identifier: MIT
//
// Algorithms on streams: sorting, duplicates, partitions. Streams and views of any rank are taken in row-major
// order. Every algorithm is stable, works in place and gives the same result on every device. A view must be
// writable where elements move. Each throws sk::Error if streams have different shapes or devices, if one is
// given twice, or if memory is exhausted.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "sk/stream.hpp"

namespace sk {

struct SortOptions {
  bool descending = false;  ///< the largest key first; NaNs come last in any case
};

namespace detail {

template <class S>
using ElementOf = typename std::remove_cvref_t<S>::value_type;

template <class S>
concept AnyStream = requires(const std::remove_cvref_t<S>& stream) {
  { regionOf(stream) } -> std::same_as<StreamRegion>;
};
template <class S>
concept Writable = AnyStream<S> && isWritable<std::remove_reference_t<S>>;
template <class T, class... Types>
inline constexpr bool isOneOf = (std::is_same_v<T, Types> || ...);

/// `values` may be null.
void sort(const StreamRegion& keys, const StreamRegion* values, const SortOptions& options);
StreamOwner order(const StreamRegion& keys, const SortOptions& options);
std::int64_t unique(const StreamRegion& keys, const StreamRegion* values);
std::int64_t partition(const StreamRegion& flags, const StreamRegion& values);

/// Makes typed streams of owners.
struct TypedStreams {
  template <ElementType T>
  static Stream<T> of(StreamOwner owner) {
    return Stream<T>(static_cast<StreamOwner&&>(owner));
  }
};

}  // namespace detail

/// A stream or view of integers of 32 or 64 bits, floats or doubles. -0 equals +0, so that they keep their order; NaNs are equal to
/// each other and come last.
template <class S>
concept SortKeys = detail::AnyStream<S> && detail::isOneOf<detail::ElementOf<S>, std::int32_t, std::uint32_t,
                                                           std::int64_t, std::uint64_t, float, double>;

/// Sorts the keys, ascending unless the options say otherwise.
template <SortKeys Keys>
  requires detail::Writable<Keys>
void sort(Keys&& keys, const SortOptions& options = {}) {
  detail::sort(regionOf(keys), nullptr, options);
}

/// Sorts the keys, and brings the values, elements of any type, into the same order. Their shapes are the same.
template <SortKeys Keys, detail::Writable Values>
  requires detail::Writable<Keys>
void sort(Keys&& keys, Values&& values, const SortOptions& options = {}) {
  const StreamRegion region = regionOf(values);
  detail::sort(regionOf(keys), &region, options);
}

/// Returns the order into which sort() would bring the keys: element i is the row-major number of the key that
/// would come i-th. The stream has the device and the shape of the keys, which do not change.
template <SortKeys Keys>
Stream<std::int32_t> order(const Keys& keys, const SortOptions& options = {}) {
  return detail::TypedStreams::of<std::int32_t>(detail::order(regionOf(keys), options));
}

/// Brings the first key of each run of equal neighbours to the front and returns the number of runs. The other
/// keys follow, in their order. A NaN equals nothing here, as in std::unique.
template <SortKeys Keys>
  requires detail::Writable<Keys>
std::int64_t unique(Keys&& keys) {
  return detail::unique(regionOf(keys), nullptr);
}

/// Likewise, and brings the values into the same order as the keys. Their shapes are the same.
template <SortKeys Keys, detail::Writable Values>
  requires detail::Writable<Keys>
std::int64_t unique(Keys&& keys, Values&& values) {
  const StreamRegion region = regionOf(values);
  return detail::unique(regionOf(keys), &region);
}

/// Brings the values whose flag is true, or not 0, to the front, before the others, and returns their number. The
/// flags, bool, int or uint, have the shape of the values and do not change.
template <detail::AnyStream Flags, detail::Writable Values>
  requires detail::isOneOf<detail::ElementOf<Flags>, bool, std::int32_t, std::uint32_t>
std::int64_t partition(const Flags& flags, Values&& values) {
  return detail::partition(regionOf(flags), regionOf(values));
}

}  // namespace sk
