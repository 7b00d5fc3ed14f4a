// SPDX-License-Identifier: MIT
#include "gl_device/pass/pass_trace.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "gl/commands.hpp"
#include "gl_device/program/program_cache.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

using assemble::Rect;

constexpr Trace::Time second = 1'000'000'000;

bool choosesTimestamps(const gl::Capabilities& capabilities) {
  const char* variable = std::getenv("SK_TRACE_CLOCK");
  const std::string_view clock = variable == nullptr ? "" : variable;
  if (!clock.empty() && clock != "timer" && clock != "finish") {
    throw Error(fmt::format("there is no clock '{}'; choose timer or finish (SK_TRACE_CLOCK)", clock));
  }
  const bool isWanted = clock.empty() ? !capabilities.isSoftware : clock == "timer";
  return isWanted && gl::hasTimestamps(capabilities);
}

std::int64_t texelsOf(const RenderTarget& plane) {
  return std::int64_t{plane.texture.size().width} * plane.texture.rows();
}

/// The bytes of all texels that a program may read, each counted once. An operand of partial results has the
/// region layout of the folded elements, although its planes have fewer texels.
std::int64_t bytesRead(const KernelProgram& program, std::span<const Operand> operands) {
  std::int64_t bytes = 0;
  for (const KernelProgram::Read& read : program.reads) {
    const Operand& operand = operands[read.parameter];
    std::int64_t elements = assemble::elements(operand.regionLayout.extent);
    if (operand.regionLayout.packed) elements = (elements + assemble::lanes - 1) / assemble::lanes;
    for (const RenderTarget& plane : operand.planes) {
      bytes += std::min(elements, texelsOf(plane)) *
               static_cast<std::int64_t>(plane.texture.format().texelBytes());
    }
  }
  return bytes;
}

std::int64_t texelsOf(std::span<const Rect> rects) {
  std::int64_t texels = 0;
  for (const Rect& rect : rects) texels += std::int64_t{rect.width} * rect.height;
  return texels;
}

}  // namespace

PassTrace::PassTrace(GlContext& context, Trace& trace)
    : trace_(trace),
      deletions_(context.bound().deletions),
      usesTimestamps_(choosesTimestamps(context.capabilities())) {}

gl::Timestamp PassTrace::takeTimestamp() {
  std::optional<gl::Timestamp> stamp;
  if (idle_.empty()) {
    stamp.emplace(deletions_);
  } else {
    stamp = std::move(idle_.back());
    idle_.pop_back();
  }
  stamp->take();
  return std::move(*stamp);
}

void PassTrace::begin(PassRecord&& record) {
  record_ = std::move(record);
  if (usesTimestamps_) {
    collect();
    begin_ = Trace::now();
    timed_.push_back({record_, takeTimestamp(), {}});
  } else {
    gl::finish();
    begin_ = Trace::now();
  }
}

void PassTrace::end() noexcept {
  try {
    trace_.hostPass(record_, begin_, Trace::now());
    if (usesTimestamps_) {
      timed_.back().end = takeTimestamp();
    } else {
      gl::finish();
      trace_.devicePass(record_, begin_, Trace::now(), "wall clock around glFinish");
    }
  } catch (const std::bad_alloc&) {
    // The pass is missing from the trace. collect() waits for the end of every pass in the list.
    if (usesTimestamps_ && !timed_.back().end) timed_.pop_back();
  }
}

/// Measures the offset of the clocks, at most once per second, because they drift.
void PassTrace::calibrate() {
  const Trace::Time now = Trace::now();
  if (calibrated_ == 0 || now - calibrated_ > second) {
    hostAhead_ = now - gl::timestampNow();
    calibrated_ = now;
  }
}

/// Passes may overlap on the device, but slices on a track must not: each one begins after the previous one's
/// end.
void PassTrace::collect() {
  if (!usesTimestamps_) return;  // the driver may not have a clock to query
  calibrate();
  while (!timed_.empty()) {
    Timed& pass = timed_.front();
    const std::optional<std::int64_t> end = pass.end ? pass.end.result() : std::nullopt;
    if (!end) return;
    if (const std::optional<std::int64_t> begin =
            pass.begin.result()) {  // none if the context was lost between both
      const Trace::Time began = std::max(*begin + hostAhead_, lastEnd_);
      lastEnd_ = std::max(*end + hostAhead_, began);
      trace_.devicePass(pass.record, began, lastEnd_, "GL timer query");
    }
    idle_.push_back(std::move(pass.begin));
    idle_.push_back(std::move(pass.end));
    timed_.pop_front();
  }
}

void PassTrace::complete() noexcept {
  gl::finish();
  try {
    collect();
  } catch (const std::bad_alloc&) {
    return;  // some passes are missing from the trace
  }
}

std::size_t texelBytesOf(std::span<RenderTarget* const> planes) {
  std::size_t bytes = 0;
  for (const RenderTarget* plane : planes) bytes += plane->texture.format().texelBytes();
  return bytes;
}
std::size_t texelBytesOf(std::span<const RenderTarget> planes) {
  std::size_t bytes = 0;
  for (const RenderTarget& plane : planes) bytes += plane.texture.format().texelBytes();
  return bytes;
}

/// The record's domain is in elements, not in texels.
PassRecord recordOf(const PassName& name, std::int64_t bytesRead, std::span<const Rect> rects,
                    std::size_t texelBytes, int elementsOfTexel) {
  const std::int64_t texels = texelsOf(rects);
  const bool isBox = rects.size() == 1 && rects.front().height > 1;
  std::string domain =
      isBox ? fmt::format("{{{}, {}}}", rects.front().height, rects.front().width * elementsOfTexel)
            : fmt::format("{{{}}}", texels * elementsOfTexel);
  return {std::string(name.kernel),
          std::string(name.step),
          name.kind,
          std::move(domain),
          bytesRead,
          texels * static_cast<std::int64_t>(texelBytes)};
}

PassRecord recordOf(const PassName& name, const KernelProgram& program, std::span<const Operand> operands,
                    std::span<const Rect> rects, std::size_t texelBytes) {
  return recordOf(name, bytesRead(program, operands), rects, texelBytes,
                  program.isPacked ? assemble::lanes : 1);
}

PassRecord recordOf(const PassName& name, std::span<const RenderTarget> planes, std::span<const Rect> rects,
                    std::size_t texelBytes) {
  std::int64_t bytes = 0;
  for (const RenderTarget& plane : planes) bytes += static_cast<std::int64_t>(plane.texture.bytes());
  return recordOf(name, bytes, rects, texelBytes);
}

PassRecord recordOf(const PassName& name, const Rect& rect, std::size_t texelBytes) {
  const std::span<const Rect> rects(&rect, 1);
  return recordOf(name, texelsOf(rects) * static_cast<std::int64_t>(texelBytes), rects, texelBytes);
}

PassName nameOf(std::string_view kernel, std::string_view step, const KernelProgram& program) {
  return {kernel, step, program.stage == assemble::Stage::Compute ? "dispatch" : "draw"};
}

std::string_view stepOf(const assemble::Task& task) {
  switch (task.work) {
    case assemble::Work::Elements: return {};
    case assemble::Work::Counts: return "counts";
    case assemble::Work::List: return "list";
    case assemble::Work::Owners: return "owners";
    case assemble::Work::Groups: return "append";
    case assemble::Work::Folds: return "fold";
    case assemble::Work::Tiles: return "tiles";
  }
  return {};
}

}  // namespace sk
