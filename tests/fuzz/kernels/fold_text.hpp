// SPDX-License-Identifier: MIT
//
// The programs of random folds: a scan, a reduce, or a kernel with folded outputs, as text for skc and as a function that
// folds one element here. Integers wrap, and floats are small multiples of 1/4 whose sums never round, so that every
// order of combination gives the same bits.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "random.hpp"
#include "sk/program.hpp"

namespace fuzz {

using sk::program::Scalar;
using Words = std::vector<std::uint32_t>;

enum class FoldKind : std::uint8_t { Scan, Reduce, Kernel };

/// What the gather parameter of a fold with uniforms holds; reads are in bounds.
inline constexpr std::size_t tableLength = 16;

/// Most elements of a domain: sums of as many floats are exact.
inline constexpr int mostFolded = 40000;

struct FoldText {
  FoldKind kind = FoldKind::Reduce;
  std::string text;  ///< the program; the fold is named `random`
  /// True if the parameters begin with a uniform uint and a gather of ints.
  bool takesUniforms = false;
  std::vector<Scalar> inputs;  ///< int, uint, or float, whose values are whole numbers from -8 to 8
  std::vector<Scalar> outputs;  ///< of a kernel
  std::vector<Scalar> accumulators;
  Words identities;  ///< one per accumulator; empty if there are none
  bool inputIsRecord = false;  ///< the inputs are the members of one struct
  bool accumulatorIsRecord = false;  ///< so are the accumulators
  bool sumsFloats = false;

  /// An element of the domain, and what its inputs are folded into.
  struct Element {
    Words inputs;
    std::uint32_t factor;  ///< the uniform
    const Words& table;  ///< the gather
    std::uint32_t index;  ///< in the fastest dimension
    Words outputs;
  };
  std::function<void(Words& accumulators, Element& element)> fold;
};

FoldText randomFold(FoldKind kind, Random& random);

}  // namespace fuzz
