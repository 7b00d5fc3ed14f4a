// SPDX-License-Identifier: MIT
#include "gl_device/fuse/tile_trials.hpp"

#include <sstream>

#include <fmt/format.h>

#include "gl_device/gl_device.hpp"
#include "probe/target_choice.hpp"
#include "support/cache_folder.hpp"

namespace sk {

namespace {

std::string nameOf(std::string_view loop) { return fmt::format("loop-tiles-{:016x}", hashOf(loop)); }

std::optional<TileVerdict> verdictIn(const std::string& text) {
  std::istringstream in(text);
  TileVerdict verdict;
  if (!(in >> verdict.iterations >> verdict.texels[0] >> verdict.texels[1] >> verdict.invocations >>
        verdict.gain))
    return std::nullopt;
  return verdict;
}

}  // namespace

std::string TileTrials::key(std::string_view loop) const {
  return fmt::format("{}, {} bytes, {:016x}",
                     trialKey(driverKey(device_.name(), device_.driver(), device_.profileName()),
                              device_.limits, device_.isSoftware()),
                     loop.size(), hashOf(loop));
}

std::optional<TileVerdict> TileTrials::find(std::string_view loop) {
  const std::string known = key(loop);
  if (const auto found = known_.find(known); found != known_.end()) return found->second;
  const std::optional<std::string> text = device_.cache.read(nameOf(loop), known);
  const std::optional<TileVerdict> verdict = text ? verdictIn(*text) : std::nullopt;
  if (verdict) known_.emplace(known, *verdict);
  return verdict;
}

void TileTrials::keep(std::string_view loop, const TileVerdict& verdict) {
  std::string known = key(loop);
  device_.cache.write(nameOf(loop), known,
                      fmt::format("{} {} {} {} {:.4g}\n", verdict.iterations, verdict.texels[0],
                                  verdict.texels[1], verdict.invocations, verdict.gain));
  known_.insert_or_assign(std::move(known), verdict);
}

}  // namespace sk
