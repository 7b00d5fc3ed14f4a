// SPDX-License-Identifier: MIT
//
// How far an output of a call is from the reference. Three arrays of each component are compared: what the device computed
// (d), what the reference computes with the device's inputs (o), and what it computes with its own (r). Then d - o is the own
// error of the call, o - r the inherited one, and d - r the total.
#pragma once

#include <cstdint>
#include <optional>

#include "native/native_stream.hpp"

namespace sk::shadow {

/// Elements with a property, and the first one.
struct Found {
  std::int64_t count = 0;
  std::int64_t first = -1;  ///< row-major number of the element
  int component = 0;  ///< of the first one
  double expected = 0;  ///< what the reference computes there with the device's inputs

  void add(std::int64_t element, int at, double value) {
    if (count++ != 0 && element >= first) return;
    first = element;
    component = at;
    expected = value;
  }
  void add(const Found& other) {
    if (other.count == 0) return;
    const std::int64_t all = count + other.count;
    if (count == 0 || other.first < first) *this = other;
    count = all;
  }
};

/// The largest difference, and the first element that has it.
struct Worst {
  double error = 0;
  std::int64_t element = -1;
  int component = 0;
  double expected = 0;  ///< what the reference computes there with the device's inputs
};

/// Sums over the components of real numbers that are finite in all three arrays, and counts of others.
struct OutputErrors {
  std::int64_t reals = 0;  ///< compared
  double reference2 = 0;  ///< sum of r * r
  double own2 = 0;  ///< sum of (d - o)^2
  double inherited2 = 0;  ///< sum of (o - r)^2
  double total2 = 0;  ///< sum of (d - r)^2
  double ownInTotal = 0;  ///< sum of (d - o)(d - r): what the own error contributes to the total
  Worst own;
  Found nans, infinities;  ///< of the device
  Found newNans, newInfinities;  ///< of the device where the reference is finite with the device's inputs
  std::int64_t lost = 0;  ///< components that are not finite on the device where the reference's are
  Found flushed;  ///< zeros of the device where the reference has a number below the smallest normal float
  std::int64_t integers = 0;  ///< components of integers and booleans
  Found ownDecisions, decisions;  ///< integers that differ from o, from r
  double integerReference2 = 0;  ///< sum of r * r over integers
  double integerTotal2 = 0;  ///< sum of (d - r)^2 over integers
  bool isSame = true;  ///< all components of d are those of r, bit by bit

  void add(const OutputErrors& other);

  /// Relative to the root mean square of the reference's components; 0 if there is no error.
  double relativeOwn() const { return relative(own2); }
  double relativeInherited() const { return relative(inherited2); }
  double relativeTotal() const { return relative(total2); }
  /// Likewise, but infinite if components are not finite where the reference's are: no digit of them is right.
  double reportedOwn() const;
  double reportedTotal() const;
  /// The relative error of integers, but at most the share that differs: an integer may be a number or a name.
  double relativeIntegers() const;
  /// The share of the total error that the call added itself, by projection on the total: 0 to 1.
  double ownShare() const;
  /// Likewise, but below 0 if its own errors make those of its inputs smaller, and above 1 if these make its own ones smaller.
  double signedOwnShare() const;
  double scale() const;  ///< the root mean square of the reference's components
  /// The root mean square of the total error; 0 if no components are finite.
  double absoluteTotal() const;

 private:
  double relative(double squares) const;
};

/// Compares dense streams of one shape on native devices. With `source`, first converts the elements of that one to `device`, which
/// has at least its precision. Without `own`, the own error counts as the total one. `own` may be `device`: the elements of the
/// source then replace its own, after they have been compared with them.
OutputErrors compare(NativeStream& device, const NativeStream* source, const NativeStream* own,
                     const NativeStream& reference);

/// Whether dense streams of one shape and of the same types have the same bits.
bool haveSameBits(const NativeStream& a, const NativeStream& b);

/// Whether components of this type are compared as real numbers.
bool isReal(program::Scalar scalar);

/// How many of an element's components are.
std::int64_t realComponents(const program::Element& element);

/// Sum over all floats of the square of what rounding to half, or else to float, changes.
double squaresOfRounding(const NativeStream& stream, bool isToHalf);

/// A component of an element, as a double; integers beyond 2^53 are rounded.
double valueAt(const NativeStream& stream, int component, std::int64_t element);

}  // namespace sk::shadow
