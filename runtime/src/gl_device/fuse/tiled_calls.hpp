// SPDX-License-Identifier: MIT
//
// The calls of a loop as one call that runs several iterations by tiles (assemble/program/tile_program.hpp).
//
// Each run begins with the streams that an iteration reads before it writes them, and ends with these; what an iteration writes
// anew is not stored. Call by call, the last iterations then write everything else (TiledIteration::after).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "assemble/program/several_bodies.hpp"
#include "assemble/program/tile_program.hpp"
#include "call/resolved_call.hpp"
#include "gl_device/program/made_kernels.hpp"
#include "sk/call.hpp"

namespace sk {

class GlDevice;
class GlCall;
class LoopState;

/// What an iteration of a loop computes from what, for tiles of any size.
class TiledIteration {
 public:
  explicit TiledIteration(GlDevice& device) : device_(device) {}

  /// Finds out what the calls do. Returns why they cannot run by tiles; empty if they can.
  std::string analyse(LoopState& loop);

  /// The most bytes of shared memory that work groups may take on this device.
  std::size_t groupBytes() const;
  /// The plans to try, the most promising one first, with at most `bytes` bytes of shared memory for a work group. A device that
  /// tries no others takes the first.
  std::vector<assemble::TilePlan> plans(std::size_t bytes) const;

  /// What the speed of the loop depends on, apart from the device.
  std::string identity() const;

  /// The iterations that must run call by call after tiles, so that all streams have what they should.
  std::int64_t after() const { return after_; }
  /// The streams that have old elements until then.
  const std::vector<StreamState*>& stale() const { return stale_; }

  /// Runs a plan's iterations. The streams must lie as planes, which isPlane() says.
  class Call {
   public:
    Call(const TiledIteration& iteration, assemble::TilePlan plan);
    void run() const;
    const assemble::TilePlan& plan() const { return plan_; }

   private:
    GlDevice& device_;
    const ResolvedCall& first_;
    assemble::TilePlan plan_;
    std::shared_ptr<const MadeKernel> made_;
    std::vector<Argument> arguments_;
    CallOptions options_;
  };
  bool isPlane() const;

  /// The names of the calls, and the bytes that an iteration moves call by call, and that tiles of a plan move per iteration.
  const std::string& names() const { return names_; }
  double bytesOfCalls() const { return static_cast<double>(bytesOfCalls_); }
  double bytesOfTiles(const assemble::TilePlan& plan) const;

 private:
  /// A uniform of a call.
  struct Uniform {
    program::Parameter parameter;
    std::string symbol;
    Argument argument;
  };

  std::string addCall(const GlCall& call);
  std::string whyNotParameter(const ResolvedCall& call, std::size_t i) const;
  std::string findReach(const ResolvedCall& call, std::size_t i, assemble::TileCall& tile);
  std::string findCarried(LoopState& loop);
  std::string findAfter(LoopState& loop);
  std::shared_ptr<MadeKernel> make(const assemble::TilePlan& plan) const;

  GlDevice& device_;
  std::vector<const ResolvedCall*> calls_;
  assemble::TilePlan plan_;  ///< of an iteration, without sizes
  assemble::SeveralBodies bodies_;
  std::vector<Uniform> uniforms_;
  std::vector<StreamState*> carried_, stale_;
  std::int64_t after_ = 0, bytesOfCalls_ = 0;
  std::string names_;
};

}  // namespace sk
