// SPDX-License-Identifier: MIT
#include "gl_device/fuse/fused_loop.hpp"

#include <utility>

#include <fmt/format.h>

#include "device/loop_state.hpp"
#include "device/loop_tiles.hpp"
#include "gl_device/fuse/gl_call.hpp"
#include "gl_device/gl_device.hpp"
#include "sk/error.hpp"

namespace sk {

void FusedLoop::analyse(LoopState& loop) {
  if (isAnalysed_) return;
  groups_.clear();  // of an attempt that has thrown
  whyNot_.assign(loop.calls().size(), {});
  const bool mayFuse = givenTileBytes().value_or(1) > 0;
  FusedCalls open(device_);
  const auto close = [&](std::size_t end) {
    const std::size_t begin = groups_.empty() ? 0 : groups_.back().end;
    if (begin == end) return;
    Group& group = groups_.emplace_back(Group{begin, end, {}});
    if (open.size() > 1) {
      group.fused = std::make_unique<FusedCalls>(std::move(open));
      group.fused->finish();
    }
    open = FusedCalls(device_);
  };
  for (std::size_t i = 0; i < loop.calls().size(); ++i) {
    RecordedCall& recorded = *loop.calls()[i];
    std::string& why = whyNot_[i];
    const auto* const call = mayFuse ? dynamic_cast<const GlCall*>(recorded.onDevice()) : nullptr;
    why = !mayFuse ? "SK_LOOP_TILES is off" : call == nullptr ? recorded.whyNotOnDevice() : call->whyAlone();
    if (why.empty() && open.size() > 0) {
      why = open.add(call->resolved());
      if (why.empty()) continue;
    }
    close(i);
    if (call != nullptr && call->whyAlone().empty()) open.add(call->resolved());
  }
  close(loop.calls().size());
  isAnalysed_ = true;
}

void FusedLoop::run(LoopState& loop, Group& group) {
  if (group.fused) {
    try {
      group.fused->run();
      group.hasRun = true;
      return;
    } catch (const Error& error) {
      if (group.hasRun || error.kind() != Error::Kind::Compile) throw;
    }
    // the driver refuses the program; nothing has been written
    group.fused.reset();
    for (std::size_t i = group.begin + 1; i < group.end; ++i) whyNot_[i] = "the driver refuses the program";
  }
  for (std::size_t i = group.begin; i < group.end; ++i) loop.calls()[i]->run();
}

void FusedLoop::runOnce(LoopState& loop) {
  analyse(loop);
  for (Group& group : groups_) run(loop, group);
  loop.exchangeStreams();
}

std::string FusedLoop::plan(LoopState& loop) {
  analyse(loop);
  std::string text;
  for (const Group& group : groups_) {
    if (group.fused) {
      text += fmt::format("{}: in one pass, {} bytes instead of {}\n", group.fused->name(),
                          group.fused->bytes(), group.fused->bytesOfCalls());
    }
    for (std::size_t i = group.begin; i < group.end && !group.fused; ++i) {
      text += fmt::format("{}: by itself{}{}\n", loop.calls()[i]->name(),
                          whyNot_[i].empty() ? "" : ", since ", whyNot_[i]);
    }
  }
  return text;
}

}  // namespace sk
