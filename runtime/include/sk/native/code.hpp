// SPDX-License-Identifier: MIT
//
// The contract between skc's object files and the runtime: the functions that skc compiles for each kernel,
// and the data that the runtime passes to them. An object file has one constant Code per kernel; the runtime
// uses the best of its entries that the CPU supports. Everything here is plain data, and compiler/native
// knows its layout (Code::version changes with it).
//
// A kernel's function computes a chunk: neighbours along x in one row of the domain or in several. The runtime divides the
// domain into chunks and shares them out among threads. It first copies inputs whose layout differs from the
// domain's to scratch memory, so that object code reads elements and neighbours without boundaries, strides
// or tails. Indices, extents and strides have the fastest dimension first.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sk/native/table.hpp"

namespace sk::native {

/// Most elements that a function computes together. Every array of a Chunk and of a fold's state may be read
/// and written up to its count rounded up to Entry::lanes.
inline constexpr std::int64_t mostLanes = 64;

/// Most rows that a function computes together.
inline constexpr std::size_t mostRows = 12;

/// The largest component of a neighbour's offset for which a gather has a slot. Code finds neighbours that are
/// farther away by the element's index.
inline constexpr std::int32_t farthestSlot = 8;

/// Records of values that elements push to a variable output or store to a scatter output. Groups of lanes
/// are in order; records within a group are in the order in which its code appends them. The runtime sorts
/// them by element (Code::isReordered) and carries out stores (ApplyFunction).
struct AppendBuffer {
  std::byte* const* arrays;  ///< one per component
  std::int64_t* targets;  ///< scatter outputs: numbers of the elements to store to, all in bounds
  /// With Code::isReordered: for each record, the number of its element in the chunk.
  std::uint32_t* elements;
  std::int64_t count;  ///< records so far
  std::int64_t capacity;  ///< records that the arrays have room for, with mostLanes more behind them
  /// Called if count >= capacity: makes room for more records, and may move the arrays. Its exceptions pass
  /// through the code.
  void (*grow)(AppendBuffer* appendBuffer);
};

/// An argument of a call, one per parameter. A uniform argument is a stream of one element; an iterator has
/// two elements, its ends.
struct Argument {
  void* const* components;  ///< one array per scalar of the element; null if the stream is omitted (sk::none)
  std::int64_t first;  ///< number of the element at index 0, whether the arrays hold it or not
  std::int64_t extent[4];  ///< of the region, or of the whole of which the arrays hold a part (sk/placed.hpp)
  std::int64_t stride[4];  ///< in elements; stride[0] of a gather or scatter output is 1
  std::int64_t multiply[4];  ///< an element input's index is the domain's, times this,
  std::int64_t divide[4];  ///< divided by this
  /// Receives the records of a variable or scatter output; null if the stream is omitted. A scatter output
  /// without an append buffer is stored to immediately, which reordered code (Code::isReordered) cannot do.
  AppendBuffer* appendBuffer;
  /// Iterators: 1 if it advances with the element number, 0 if with the index in each dimension.
  std::int64_t countsElements;
  /// 1 if all element numbers fit 32 bits; 2 if sums of multiples of strides, computed modulo 2^32 and sign-extended, lead
  /// from element number `start` to every element; else 0.
  std::int64_t isSmall;
  std::int64_t start;  ///< the element from which such sums count; `first` if isSmall is 1
  /// Gathers: the element at an index from `low` to `high` (exclusive) has number first + sum(index * stride). The
  /// boundary mode brings other indices inside; what is outside then is not held, and reads the nearest index that is.
  /// 0 and `extent`, unless the arrays hold a part of a whole.
  std::int64_t low[4], high[4];
};

/// A call of a kernel.
struct Frame {
  const Argument* arguments;
  std::int64_t domain[4];
  const Table* tables;  ///< one per tabulated function; null if these are computed
  std::int64_t isSilent = 0;  ///< 1: nothing is printed
};

/// The elements `x`, `x + step` ... in a row of the domain, or in several rows.
struct Chunk {
  void* const* arrays;  ///< for each slot, its component arrays from the chunk's first element on (Slot)
  std::int64_t first[4];  ///< index of the first element
  std::int64_t count;  ///< elements of a row; in a fold, of all rounds
  std::int64_t step;  ///< between the x of consecutive elements: 1, except in folds
  /// RunFunction: consecutive rows with `count` elements each; 1 if the kernel has no slots of neighbours. Other
  /// functions ignore it.
  std::int64_t rows;
  const std::int64_t* rowSteps;  ///< RunFunction: for each array, bytes from one row to the next
};

/// A parameter for which a chunk has arrays: an element input, an output, or a row of a gather's neighbours.
struct Slot {
  std::uint8_t parameter;
  /// Gathers: offsets in y, z and w. x + dx in the array is the neighbour at dx, for |dx| up to `reach`.
  std::int8_t row[3];
  std::uint8_t reach;  ///< gathers: the largest |dx|
  std::uint8_t isOutput;
};

/// Computes a chunk.
using RunFunction = void(const Frame*, const Chunk*);
/// Computes Entry::rows chunks of one row each in consecutive rows, which have the same x and `count`.
using RunRowsFunction = void(const Frame*, const Chunk* chunks);
/// Folds a chunk of `leaves` leaves, a power of 2, into `columns` accumulators each. Element k + (r + l *
/// rounds) * columns is folded into column k of leaf l, in order of r. `state` has one array for each scalar
/// of the accumulators, with the columns of leaf l from number columns * l' on, where l' is l with its bits
/// reversed: the second half of all columns then holds the leaves that follow those of the first half. If
/// `starts` is 1, columns begin with the identity, or with their first element in a seeded reduction; else
/// with the contents of `state`. If `leaves` is above 1, `starts` is 1 and `columns` is a multiple of
/// Entry::lanes.
using FoldFunction = void(const Frame*, const Chunk*, void* const* state, std::int64_t columns,
                          std::int64_t rounds, std::int64_t leaves, std::int64_t starts);
/// Folds `later` into `state`, column by column.
using CombineFunction = void(const Frame*, void* const* state, void* const* later, std::int64_t columns);
/// Folds the elements of a chunk, in order, into the first column of `state`, which starts as in a FoldFunction. Stores
/// the accumulators after each element, or before it if `isExclusive` is 1, to `results`: one array per scalar, from the
/// chunk's first element on. An input's array may be a result's, too. Without identities, ignores `isExclusive`; with
/// them, the first result of an exclusive scan that starts is the identity.
using ScanFunction = void(const Frame*, const Chunk*, void* const* state, void* const* results,
                          std::int64_t starts, std::int64_t isExclusive);
/// Folds `rows` rows of elements, one after the other and each in order: row r has the elements starts[r] to
/// starts[r + 1] - 1 of the domain, the first of which is the chunk's first or a later one. Stores the accumulators of
/// row r to column r of `state`. A row without elements has the identities; without identities, there is none.
using FoldRowsFunction = void(const Frame*, const Chunk*, const std::int32_t* starts, void* const* state,
                              std::int64_t rows);
/// Carries out the records of a scatter output, in order. `appendBuffer` has no `elements`.
using ApplyFunction = void(const Frame*, const AppendBuffer* appendBuffer, std::int64_t parameter);
/// Writes one element of each array: the identities of a reduction, or the values out of bounds of gathers
/// with Boundary::Border; all components of one parameter, then the next.
using ValuesFunction = void(const Frame*, void* const* values);

/// FoldFloatRows is FoldRows with Real::Double where the arrays of all arguments hold floats.
enum class EntryKind : std::uint8_t {
  Run,
  Fold,
  Combine,
  Identity,
  Borders,
  Apply,
  RunRows,
  Scan,
  FoldRows,
  FoldFloatRows
};
enum class Real : std::uint8_t { Float, Double, Quad };  ///< represents the language's float
/// Generations of a CPU: x86-64, x86-64-v3, x86-64-v4. Each runs the code of earlier ones. Other CPUs have
/// one level.
enum class Level : std::uint8_t { Base, V3, V4 };

/// The highest level of this machine's CPU.
inline Level levelOfHardware() {
#if defined(__x86_64__) && defined(__GNUC__)
  return __builtin_cpu_supports("x86-64-v4")   ? Level::V4
         : __builtin_cpu_supports("x86-64-v3") ? Level::V3
                                               : Level::Base;
#else
  return Level::Base;
#endif
}

struct Entry {
  void (*function)();  ///< its type depends on `kind`
  EntryKind kind;
  Real real;
  Level level;
  std::uint8_t isContracted;  ///< products and sums may be fused
  std::uint8_t lanes;  ///< elements of a row computed together: a power of 2
  std::uint8_t rows;  ///< rows that RunRows computes together; 1 for other kinds
};

/// The native code of one kernel.
struct Code {
  static constexpr std::uint32_t currentVersion = 9;
  std::uint32_t version;
  std::uint32_t entryCount;
  const Entry* entries;
  const Slot* slots;
  std::uint32_t slotCount;
  /// Times of elements may differ widely, because loops have data-dependent trip counts; or elements print, so that none may be
  /// computed twice.
  std::uint8_t isUneven;
  /// An element may have several records; if several elements are computed together, records carry element
  /// numbers.
  std::uint8_t isReordered;
  std::uint8_t isLight;  ///< computing an element takes less time than recording what it scatters
  /// Bit i: loops of the RunRows entries read vectors of parameter i, a gather, which all of their rows share.
  std::uint64_t sharedGathers;
};

}  // namespace sk::native
