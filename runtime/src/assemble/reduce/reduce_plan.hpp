// SPDX-License-Identifier: MIT
//
// The passes of a reduction, as a pure schedule. To run it:
//
//   source = the inputs' planes
//   for each pass: target = pass.toResult ? the results' planes
//                                         : new planes of the accumulators' types and of pass.texture's shape
//                  use reduceProgram(pass.variant), set pass.uniforms, bind source and target,
//                  draw each rectangle of pass.draws (viewport = rectangle);  source = target
//
// If a device cannot draw to all targets at once, a pass is drawn for a part of them at a time
// (ReduceVariant::firstPlane). The caller adds what depends on the arguments (access, specs).
//
// The first pass folds elements in runs of up to `fanIn`; later passes fold its partial results in the same
// way until one is left for each block. The order is row-major throughout. Partial result r of block b has
// number r * blocks + b in a linearised texture.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "assemble/reduce/reduce_program.hpp"
#include "assemble/region_layout.hpp"

namespace sk::assemble {

/// The value of an `int` or `ivec4` uniform. Names that the program does not use (location -1) must be
/// skipped.
struct UniformValue {
  std::string_view name;  ///< static
  bool isVector;
  Index4 value;  ///< an int is value[0]
};

struct ReducePass {
  ReduceVariant variant;
  bool toResult;  ///< writes the result rather than a temporary
  TextureShape texture;  ///< of the temporary; empty if toResult
  std::vector<Rect> draws;
  Rect groups = {};  ///< of passes whose invocations store results by themselves: the work groups
  std::vector<UniformValue> uniforms;
};

struct ReduceLimits {
  TextureLimits texture;
  std::int32_t fanIn = program::longestRun;  ///< elements per run, at least 2
  bool grouped = false;  ///< passes are dispatches, whose work groups may fold partial results together
  /// From this many elements or texels on, programs are specialised for the length of runs.
  std::int32_t knownRuns = 1 << 16;
  /// Texels or elements of a run that consists of parts, if order does not matter and a program can combine
  /// them: a multiple of longestPart. 0: no such runs.
  std::int32_t longRun = 0;
  bool toBuffer = false;  ///< the result is a value and goes to a buffer (ReduceVariant::toBuffer)
};

/// Texels or elements per part of a long run: few, so that errors grow with the number of parts and compilers
/// unroll it.
inline constexpr std::int32_t longestPart = 8;

/// Whether a program that folds elements can also combine its results, of parts or of invocations, each of
/// which starts from an identity.
bool foldsInGroups(const program::Reduction& reduction);

/// Whether a dispatch may leave a value of this reduction in a buffer: 32-bit components, and no more planes
/// than every device can write at once.
bool mayEndInBuffer(const program::Reduction& reduction);

/// Whether a fold reads the index of its elements, or the extents of the domain.
bool readsElementIndex(const program::Kernel& fold);

/// How the elements are divided into blocks and addressed.
struct Division {
  Index4 blocks;  ///< in each dimension of the elements: divisors of their extents
  bool byIndex = false;  ///< Walk::Index; only the extent of the elements' region layout matters then
  bool byTexel = false;  ///< the elements are packed, and blocks consist of whole texels
  bool inAnyOrder = false;  ///< Reduction::commutative
  bool inGroups = false;  ///< foldsInGroups()
  /// Work groups fold the blocks (reduce_program.cpp). With byTexel, all inputs are packed, and their texels have the same
  /// x.
  bool byGroups = false;
  bool ofDigits = false;  ///< folds the terms of an exact sum (sk/exact_digits.hpp)
};

/// Plans the passes that fold elements into `result`, whose elements are the blocks, in order. Neither is
/// empty. A pass that writes the result must not read a texture of its planes.
std::vector<ReducePass> planReduction(const RegionLayout& elements, const RegionLayout& result,
                                      const ReduceLimits& limits, const Division& division);
/// Like the other planReduction, with the result's extents as the number of blocks.
std::vector<ReducePass> planReduction(const RegionLayout& elements, const RegionLayout& result,
                                      const ReduceLimits& limits);

/// Sets where a pass writes. `usesIndex`: its program needs more than the number of a result.
void addDomain(ReducePass& pass, const RegionLayout& domain, bool usesIndex);

/// Plans the pass that writes the identities to `result`, which is not empty.
ReducePass planIdentities(const RegionLayout& result);

/// The layout of a reduction to a value: a 1 x 1 texture.
RegionLayout valueLayout();

}  // namespace sk::assemble
