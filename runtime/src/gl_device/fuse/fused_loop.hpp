// SPDX-License-Identifier: MIT
//
// The calls of a loop on a GL device, in as few passes as compute the same bits: neighbouring calls run as one
// (fused_calls.hpp).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "gl_device/fuse/fused_calls.hpp"

namespace sk {

class GlDevice;
class LoopState;

class FusedLoop {
 public:
  explicit FusedLoop(GlDevice& device) : device_(device) {}

  /// Runs all calls once, and exchanges the elements of the streams that were swapped.
  void runOnce(LoopState& loop);
  /// What Loop::plan() says of each call.
  std::string plan(LoopState& loop);

 private:
  /// Neighbouring calls in one pass, or a call by itself.
  struct Group {
    std::size_t begin, end;  ///< numbers of calls in the loop
    std::unique_ptr<FusedCalls> fused;  ///< null if the calls run one by one
    bool hasRun = false;
  };

  void analyse(LoopState& loop);
  void run(LoopState& loop, Group& group);

  GlDevice& device_;
  bool isAnalysed_ = false;
  std::vector<Group> groups_;
  std::vector<std::string> whyNot_;  ///< why a call is not in the pass of the one before, for each call
};

}  // namespace sk
