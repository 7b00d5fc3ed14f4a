// SPDX-License-Identifier: MIT
//
// What skc's object files and the runtime agree on: the functions that skc compiles for each kernel, and what the runtime
// hands to them. An object file has one constant Code for each kernel; the runtime chooses among its entries the best one
// that the CPU runs. Everything here is plain data, whose layout compiler/native knows (Code::version tells of it).
//
// A kernel's function computes a chunk: neighbours along x in one row of the domain. The runtime divides the domain into
// chunks, shares them out among threads, and brings what does not lie as the domain does into scratch memory first, so that
// object code knows of no boundaries, strides or tails where it reads elements and their neighbours. Indices, extents and
// strides have the fastest dimension first.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sk/native/table.hpp"

namespace sk::native {

/// Elements that a function computes together, at most. Every array of a Chunk and of a State may be read and written up to
/// its count rounded up to Entry::lanes.
inline constexpr std::int64_t mostLanes = 64;

/// Rows that a function computes together, at most.
inline constexpr std::size_t mostRows = 12;

/// Records of what elements push to a variable output or store to a scatter output: the latest group of lanes last, and within a
/// group in the order in which its code comes to them. The runtime brings them into the order of elements (Code::isReordered)
/// and, where they were stored, carries them out (ApplyFunction).
struct AppendBuffer {
  std::byte* const* arrays;  ///< one for each component
  std::int64_t* targets;  ///< of a scatter output: numbers of the elements to store to, all of which exist
  std::uint32_t*
      elements;  ///< of Code::isReordered: numbers in the chunk of the elements that records come from
  std::int64_t count;  ///< records so far
  std::int64_t capacity;  ///< records that the arrays have room for, with mostLanes more behind them
  /// Called where count >= capacity: makes room for more, and may move the arrays. What it throws goes through the code.
  void (*grow)(AppendBuffer* appendBuffer);
};

/// An argument of a call, one for each parameter. A uniform argument is a stream of one element; an iterator has two
/// elements, its ends.
struct Argument {
  void* const*
      components;  ///< an array for each scalar of the element; null where the stream is left out (sk::none)
  std::int64_t first;  ///< number of the region's first element in the arrays
  std::int64_t extent[4];  ///< of the region
  std::int64_t stride[4];  ///< in elements; stride[0] of a gather or scatter output is 1
  std::int64_t multiply[4];  ///< an element input's index is the domain's, times this,
  std::int64_t divide[4];  ///< divided by this
  /// Takes the records of a variable or scatter output; null where the stream is left out. A scatter output without an append buffer is
  /// stored to at once, which code that is reordered (Code::isReordered) cannot do.
  AppendBuffer* appendBuffer;
  std::int64_t
      countsElements;  ///< of an iterator: 1 where it goes by element number, 0 by index in each dimension
  std::int64_t isSmall;  ///< 1 where the numbers of all elements fit 32 bits
};

/// A call of a kernel.
struct Frame {
  const Argument* arguments;
  std::int64_t domain[4];
  const Table* tables;  ///< one for each tabulated function; null where these are computed
};

/// Elements `x`, `x + step` ... of a row of the domain.
struct Chunk {
  void* const* arrays;  ///< for each slot, its component arrays from the chunk's first element on (Slot)
  std::int64_t first[4];  ///< index of the first element
  std::int64_t count;  ///< elements; of a fold, in all rounds
  std::int64_t step;  ///< between the x of one element and the next: 1, except in folds
};

/// A parameter whose elements a chunk has arrays for: an element input, an output, or a row of neighbours of a gather.
struct Slot {
  std::uint8_t parameter;
  std::int8_t row
      [3];  ///< of a gather: offsets in y, z and w. x + dx of the array is the neighbour at dx, within `reach`
  std::uint8_t reach;  ///< of a gather: the largest |dx|
  std::uint8_t isOutput;
};

/// void(const Frame*, const Chunk*): computes a chunk.
using RunFunction = void(const Frame*, const Chunk*);
/// The same for Entry::rows chunks in consecutive rows, of the same elements along x and `count`.
using RunRowsFunction = void(const Frame*, const Chunk* chunks);
/// Folds a chunk of `leaves` leaves, a power of 2, into `columns` accumulators each. Element k + (r + l * rounds) * columns is
/// folded into column k of leaf l, in order of r. `state` has an array for each scalar of the accumulators, which holds the
/// columns of leaf l from number columns * l' on, l' being l with its bits reversed: the second half of all columns then
/// follows the first half leaf by leaf. Where `starts` is 1, columns begin with the identity or, of
/// a seeded reduction, with their first element; else with what `state` holds. Several leaves always start, and `columns` is
/// then a multiple of Entry::lanes.
using FoldFunction = void(const Frame*, const Chunk*, void* const* state, std::int64_t columns,
                          std::int64_t rounds, std::int64_t leaves, std::int64_t starts);
/// Folds later results into earlier ones, column by column.
using CombineFunction = void(const Frame*, void* const* state, void* const* later, std::int64_t columns);
/// Carries out the records of a scatter output, in their order. `append buffer` has no `elements`.
using ApplyFunction = void(const Frame*, const AppendBuffer* appendBuffer, std::int64_t parameter);
/// Writes one element of each array: the identities of a reduction, or what a gather with Boundary::Border has outside,
/// all components of one parameter after the other.
using ValuesFunction = void(const Frame*, void* const* values);

enum class EntryKind : std::uint8_t { Run, Fold, Combine, Identity, Borders, Apply, RunRows };
enum class Real : std::uint8_t { Float, Double, Quad };  ///< what stands for the language's float
/// Generations of a CPU, of which each runs what those before it run: x86-64, x86-64-v3, x86-64-v4. Other CPUs have one.
enum class Level : std::uint8_t { Base, V3, V4 };

struct Entry {
  void (*function)();  ///< by kind
  EntryKind kind;
  Real real;
  Level level;
  std::uint8_t isContracted;  ///< multiplications and additions may be fused
  std::uint8_t lanes;  ///< elements of a row computed together: a power of 2
  std::uint8_t rows;  ///< that RunRows computes together; 1 for all others
};

/// All that was compiled for one kernel.
struct Code {
  static constexpr std::uint32_t currentVersion = 3;
  std::uint32_t version;
  std::uint32_t entryCount;
  const Entry* entries;
  const Slot* slots;
  std::uint32_t slotCount;
  std::uint8_t
      isUneven;  ///< elements may take very different times: it has loops whose trip count depends on data
  /// An element may have several records: where more than one element is computed together, they come with its number.
  std::uint8_t isReordered;
  std::uint8_t isLight;  ///< an element takes less time than recording what it scatters
};

}  // namespace sk::native
