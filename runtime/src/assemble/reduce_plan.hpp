// SPDX-License-Identifier: MIT
//
// The passes of a reduction as a pure schedule. To run one:
//
//   source = the input's planes
//   for each pass: target = pass.toResult ? the result's planes
//                                         : new planes of the accumulator's type, pass.width x pass.height
//                  use reduceProgram(pass.variant), set pass.uniforms, bind source and target,
//                  draw each rectangle of pass.draws (viewport = rectangle);  source = target
//
// A first pass folds elements in runs of up to `fanIn`; the later ones fold its partial results in
// the same way until one is left for each block. Order is row-major throughout. Partial result r of
// block b has number r * blocks + b in a linearised texture.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "assemble/placement.hpp"
#include "assemble/reduce_program.hpp"

namespace sk::assemble {

/// Value of an `int` or `ivec4` uniform. A name that the program turned out not to use (location -1)
/// is to be skipped.
struct UniformValue {
  std::string_view name;   ///< static
  bool isVector;
  Index4 value;            ///< an int is value[0]
};

struct ReducePass {
  ReduceVariant variant;
  bool toResult;                        ///< renders into the result, else into a temporary
  std::int32_t width, height;           ///< of the temporary; 0 where toResult
  std::vector<Rect> draws;
  std::vector<UniformValue> uniforms;
};

struct ReduceLimits {
  std::int32_t textureSize;             ///< largest width and height
  std::int32_t fanIn = 32;              ///< elements a run, 2 or more
};

/// The passes that fold `input` into `result`, whose extents divide those of `input`; neither is empty.
/// `aliased`: the result lies in a texture of the input's, which must then not be read by the pass
/// that writes it.
std::vector<ReducePass> planReduction(const Placement& input, const Placement& result,
                                      const ReduceLimits& limits, bool aliased = false);

/// The result of a reduction to a value: a 1 x 1 texture.
Placement valuePlacement();

}  // namespace sk::assemble
