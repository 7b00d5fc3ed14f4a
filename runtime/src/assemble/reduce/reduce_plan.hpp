// SPDX-License-Identifier: MIT
//
// The passes of a reduction as a pure schedule. To run one:
//
//   source = the inputs' planes
//   for each pass: target = pass.toResult ? the results' planes
//                                         : new planes of the accumulators' types and of pass.texture's shape
//                  use reduceProgram(pass.variant), set pass.uniforms, bind source and target,
//                  draw each rectangle of pass.draws (viewport = rectangle);  source = target
//
// Where the targets are more than the device draws to at once, a pass is drawn for a part of them at a
// time (ReduceVariant::firstPlane). What only the arguments decide (access, specs) is the caller's to add.
//
// A first pass folds elements in runs of up to `fanIn`; the later ones fold its partial results in
// the same way until one is left for each block. Order is row-major throughout. Partial result r of
// block b has number r * blocks + b in a linearised texture.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "assemble/reduce/reduce_program.hpp"
#include "assemble/region_layout.hpp"

namespace sk::assemble {

/// Value of an `int` or `ivec4` uniform. A name that the program turned out not to use (location -1)
/// is to be skipped.
struct UniformValue {
  std::string_view name;  ///< static
  bool isVector;
  Index4 value;  ///< an int is value[0]
};

struct ReducePass {
  ReduceVariant variant;
  bool toResult;  ///< renders into the result, else into a temporary
  TextureShape texture;  ///< of the temporary; of no size where toResult
  std::vector<Rect> draws;
  std::vector<UniformValue> uniforms;
};

struct ReduceLimits {
  TextureLimits texture;
  std::int32_t fanIn = program::longestRun;  ///< elements a run, 2 or more
  bool grouped = false;  ///< passes are dispatches, of which a work group may fold partial results together
  std::int32_t knownRuns = 1 << 16;  ///< elements or texels from which on programs know how long runs are
  /// Texels or elements of a run of parts, where order does not count and a program can combine them: a multiple of
  /// longestPart. 0: there are no such runs.
  std::int32_t longRun = 0;
  bool toBuffer = false;  ///< the result is a value, and goes to a buffer (ReduceVariant::toBuffer)
};

/// Texels or elements of a part of a long run: few, so that an error grows with the parts, and compilers unroll them.
inline constexpr std::int32_t longestPart = 8;

/// Whether a program that folds elements can also combine what it has folded, by parts or by invocations, each starting from
/// an identity.
bool foldsInGroups(const program::Reduction& reduction);

/// Whether a dispatch may leave a value of this reduction in a buffer: components of 32 bits, of as many planes as any device
/// writes at once.
bool mayEndInBuffer(const program::Reduction& reduction);

/// Whether a fold asks where its elements are, so that it has to find them by their index.
bool asksForPlace(const program::Kernel& fold);

/// How the elements are divided into blocks, and found.
struct Division {
  Index4 blocks;  ///< in each dimension of the elements: divisors of their extents
  bool byIndex = false;  ///< Walk::Index; of the elements' region layout only the extent counts then
  bool byTexel = false;  ///< the elements are packed, and blocks made of whole texels
  bool inAnyOrder = false;  ///< Reduction::commutative
  bool inGroups = false;  ///< foldsInGroups()
};

/// The passes that fold elements into `result`, whose elements are the blocks, in their order. There are
/// some of both. No pass that writes the result may read a texture of its planes.
std::vector<ReducePass> planReduction(const RegionLayout& elements, const RegionLayout& result,
                                      const ReduceLimits& limits, const Division& division);
/// The same where result's extents are the numbers of blocks.
std::vector<ReducePass> planReduction(const RegionLayout& elements, const RegionLayout& result,
                                      const ReduceLimits& limits);

/// The pass that writes the identities to `result`, which has elements.
ReducePass planIdentities(const RegionLayout& result);

/// The result of a reduction to a value: a 1 x 1 texture.
RegionLayout valueLayout();

}  // namespace sk::assemble
