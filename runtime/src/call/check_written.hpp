// SPDX-License-Identifier: MIT
//
// SK_CHECK=written: finds reads of elements that nothing has written since the application created their stream. Each stream knows
// these elements (StreamState::unwritten). Operations that read all elements of a region are checked here; what kernels
// read is found by running them (call/check_unwritten_reads.hpp). Must not depend on the kind of device.
//
// Reads the environment variable SK_CHECK, which enables slow checks for finding mistakes.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "sk/stream.hpp"

namespace sk {

// All throw sk::Error for a value that names no check. The first device or domain that is opened asks for the value, so that a check
// that does not exist is not taken for one that finds nothing.

/// Throws sk::Error if SK_CHECK names no check.
void requireKnownCheck();

/// Whether SK_CHECK is `folds`: reductions are tested on elements of each call (native/check_fold.hpp).
bool checksFolds();
/// Whether SK_CHECK is `halos`: the reach of gathers is tested on elements of each call (call/check_halos.hpp).
bool checksHalos();
/// Whether SK_CHECK is `written`: reads of elements that nothing has written are errors.
bool checksWritten();
/// Whether SK_CHECK is `asserts`: kernels' assertions are evaluated (call/check_asserts.hpp).
bool checksAsserts();
/// Whether SK_CHECK is `ranges`: arguments and results are compared with their ranges (call/check_ranges.hpp).
bool checksRanges();
/// Whether SK_CHECK is `collectives`: the ranks of a domain compare every call (mpi/agreement.hpp).
bool checksCollectives();

class StreamState;

/// Lets a new stream know its elements that nothing has written: all of them.
void trackWritten(StreamState& stream);

/// The elements of a region that nothing has written, as row-major numbers of the region's elements, in ascending order. The
/// stream is settled unless all of its elements have been written.
std::vector<std::int64_t> unwrittenIn(const StreamRegion& region);

/// Throws sk::Error if nothing has written one of the region's elements; `context` names the operation that reads them.
void checkWritten(const StreamRegion& region, std::string_view context);

/// Throws sk::Error if nothing has written any of the region's elements, which are to be copied. Copies of a region that is written
/// in part are written in part (noteCopied).
void checkSomeWritten(const StreamRegion& region, std::string_view context);

/// Notes that an operation has written all elements of a region.
void noteWritten(const StreamRegion& region);
/// Likewise for some of them, which are given like those of unwrittenIn().
void noteWritten(const StreamRegion& region, std::span<const std::int64_t> numbers);
/// Notes that all elements of a stream have been written, or may have been.
void noteAllWritten(StreamState& stream);

/// Notes that elements have been copied to a region, of which `unwritten` (unwrittenIn of the source) had never been written.
void noteCopied(const StreamRegion& to, std::span<const std::int64_t> unwritten);

/// The index of element number `number`, row-major, of a shape.
Index indexOf(const Shape& shape, std::int64_t number);

}  // namespace sk
