// SPDX-License-Identifier: MIT
//
// Compute programs that run several iterations of a loop's calls on a tile of their domain. A work group fetches the texels of the tile
// and of as many around it as all iterations reach. It computes call after call; of what is around the tile, each call
// leaves less that is right, down to the tile itself. What calls read at neighbours is in shared memory, everything else stays with
// its invocation. In the end the group stores the tile. Groups compute what is around their tiles for themselves, so that none waits
// for another.
//
//    u  ------[ heat ]--- a1 ---[ heat ]--- a2 ...   value 0 is u before an iteration, value 1 is what heat has computed;
//                  (next[0] = 1)                      in the next iteration, value 0 is that
//
// Domains are planes whose texels hold four elements, and all streams have their shape.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "assemble/assemble.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// A call of an iteration. There is one entry for each parameter of its kernel.
struct TileCall {
  const program::Kernel* kernel;
  std::string entry;  ///< its function's name in the body of all
  std::vector<std::string> arguments;  ///< uniforms and spec parameters: the value; others: empty
  std::vector<int> values;  ///< inputs, outputs and gathers: the number of the value; others: -1
  std::vector<std::string> symbols;  ///< gathers: the suffix of the functions by which the body reads it
  std::array<int, 2> reach{};  ///< how many elements from its own it reads, in x and y
};

struct TilePlan {
  int iterations = 1;
  std::array<int, 2> texels{};  ///< columns and rows of a tile with all that is around it
  int invocations = 0;  ///< of a work group: a multiple of 32, and of the columns
  bool isPeriodic = false;  ///< all gathers wrap; otherwise none does
  /// Values are numbered: first those of the streams before an iteration, then what calls compute.
  std::size_t carried = 0;  ///< the number of such streams
  std::vector<int> next;  ///< for each of them, the value that it has after an iteration
  std::vector<const program::Element*>
      elements;  ///< of each value: one scalar whose texels need no conversion
  std::vector<bool> isNear;  ///< for each value, whether a gather reads it
  std::vector<TileCall> calls;

  /// Elements that the calls of an iteration reach.
  std::array<int, 2> reach() const;
  /// Texels around a tile on each side.
  std::array<int, 2> halo() const;
  /// Texels that a work group stores.
  std::array<int, 2> stored() const { return {texels[0] - 2 * halo()[0], texels[1] - 2 * halo()[1]}; }
  /// Bytes of shared memory.
  std::size_t sharedBytes() const;
};

/// The plan as comments, by which kernels with the same bodies differ.
std::string describe(const TilePlan& plan);

/// The program. `kernel` has the bodies of all calls; its parameters are a Gather for each carried stream, in order, an Output for
/// each whose value changes, and the uniforms. `variant` is a packed plane that is no view.
std::string tileProgram(const Profile& profile, const program::Kernel& kernel, const Variant& variant,
                        const TilePlan& plan);

}  // namespace sk::assemble
