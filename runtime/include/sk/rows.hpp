// SPDX-License-Identifier: MIT
//
// Rows of different lengths: where each row of a one-dimensional stream begins, prepared once for reduces and scans that
// fold each row on its own.
#pragma once

#include <cstdint>
#include <type_traits>

#include "sk/owner.hpp"
#include "sk/stream.hpp"

namespace sk {

class RowsState;  // the runtime's own

namespace detail {

struct RowsDeleter {
  /// A loop may keep the rows for its calls.
  void operator()(RowsState* state) const noexcept;
};
using RowsOwner = Owner<RowsState, RowsDeleter>;

RowsOwner makeRows(const StreamRegion& starts);
/// Throws sk::Error if the rows were moved from.
const RowsState& checked(const RowsOwner& rows);

}  // namespace detail

/// The elements of a stream in rows, an argument for an element input of a reduce or a scan. Created by Rows. It is
/// valid for one call, as long as the rows and the stream exist.
template <class T>
struct InRows {
  StreamRegion region;
  const RowsState* rows;
};

/// Row i of a stream has the elements starts[i] to starts[i + 1] - 1, as in a sparse matrix in compressed rows.
/// `starts`, a one-dimensional stream or view, has one element more than there are rows; it starts at 0 or above, and
/// never decreases. The constructor reads it, which waits for the device, and keeps what it needs: later changes of
/// `starts` have no effect. Throws sk::Error if a start is negative or less than the one before.
class Rows {
 public:
  template <class S>
    requires std::is_same_v<typename S::value_type, std::int32_t>
  explicit Rows(const S& starts) : state_(detail::makeRows(regionOfStarts(starts))) {}

  /// The number of rows, also after the device has ended.
  std::int64_t count() const;
  /// The end of the last row: a stream in rows has at least as many elements. Also after the device has ended.
  std::int64_t end() const;

  /// A one-dimensional stream or view in these rows, for one call. Throws sk::Error if the rows were moved from; the
  /// call throws it if the stream is too short, or is on another device.
  template <class S>
    requires requires { typename S::value_type; }
  InRows<typename S::value_type> operator()(const S& stream) const {
    return {regionOf(stream), &detail::checked(state_)};
  }

 private:
  template <class S>
  static StreamRegion regionOfStarts(const S& starts) {
    static_assert(
        requires { regionOf(starts); },
        "StreamKernel: the starts of rows are a stream on the device; write them to a device.stream<int>()");
    return regionOf(starts);
  }

  detail::RowsOwner state_;
};

}  // namespace sk
