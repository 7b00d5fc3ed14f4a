// SPDX-License-Identifier: MIT
//
// Records the passes of a GL device in its trace. On a GPU, times come from timestamps, which are collected
// later, without waiting. Without timestamps, and on software renderers, whose timestamps miss most of the
// work, each pass is timed separately by the host's clock, between two waits for the device. The trace names
// the clock.
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "assemble/region_layout.hpp"
#include "gl/queue_points.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/pass/pass.hpp"
#include "trace/trace.hpp"

namespace sk {

class PassTrace {
 public:
  /// A DeviceScope must be open whenever this class is used.
  PassTrace(GlContext& context, Trace& trace);

  void begin(PassRecord&& record);
  void end() noexcept;
  /// Adds the passes whose times are known by now to the trace.
  void collect();
  /// Waits for the passes that are not in the trace yet, and adds them.
  void complete() noexcept;

 private:
  struct Timed {
    PassRecord record;
    gl::Timestamp begin, end;
  };

  void calibrate();
  gl::Timestamp takeTimestamp();

  Trace& trace_;
  gl::Deletions& deletions_;
  const bool usesTimestamps_;
  PassRecord record_;  ///< of the current pass
  Trace::Time begin_ = 0;  ///< of the current pass, by the host's clock
  std::deque<Timed> timed_;  ///< passes that may be pending; the last one may lack its end
  std::vector<gl::Timestamp> idle_;
  Trace::Time calibrated_ = 0;
  Trace::Time hostAhead_ = 0;  ///< the host's clock minus the device's
  Trace::Time lastEnd_ = 0;  ///< end of the last slice on the device's track
};

/// The name of a pass in the trace: the members of a PassRecord.
struct PassName {
  std::string_view kernel;
  std::string_view step = {};
  std::string_view kind = "draw";
};

/// The bytes that a pass writes per texel, over all planes.
std::size_t texelBytesOf(std::span<RenderTarget* const> planes);
std::size_t texelBytesOf(std::span<const RenderTarget> planes);

/// The record of a pass of a kernel's program, which writes `texelBytes` bytes for each texel of `rects`.
PassRecord recordOf(const PassName& name, const KernelProgram& program, std::span<const Operand> operands,
                    std::span<const assemble::Rect> rects, std::size_t texelBytes);
/// The record of a pass that reads `bytesRead` bytes. Each texel holds `elementsOfTexel` elements.
PassRecord recordOf(const PassName& name, std::int64_t bytesRead, std::span<const assemble::Rect> rects,
                    std::size_t texelBytes, int elementsOfTexel = 1);
/// The record of a pass that reads all texels of `planes`.
PassRecord recordOf(const PassName& name, std::span<const RenderTarget> planes,
                    std::span<const assemble::Rect> rects, std::size_t texelBytes);

/// The record of a copy of texels to a rectangle of the target.
PassRecord recordOf(const PassName& name, const assemble::Rect& rect, std::size_t texelBytes);

/// The name of a pass that runs a kernel's program: a draw or a dispatch.
PassName nameOf(std::string_view kernel, std::string_view step, const KernelProgram& program);

/// The step of a pass of a kernel; empty for Work::Elements.
std::string_view stepOf(const assemble::Task& task);

/// Traces and counts a pass, which lasts as long as this object; does nothing if the device does neither.
/// Scopes must not overlap. The arguments after the name are those of a recordOf().
class PassScope {
 public:
  template <class... What>
  PassScope(GlDevice& device, const PassName& name, const What&... what) : trace_(device.passes().trace()) {
    if (trace_ == nullptr && !device.passCount) return;
    PassRecord record = recordOf(name, what...);
    if (device.passCount) record.addTo(*device.passCount);
    if (trace_ != nullptr) trace_->begin(std::move(record));
  }
  ~PassScope() {
    if (trace_ != nullptr) trace_->end();
  }
  PassScope(const PassScope&) = delete;
  PassScope& operator=(const PassScope&) = delete;

 private:
  PassTrace* trace_;
};

}  // namespace sk
