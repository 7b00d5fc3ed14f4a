// SPDX-License-Identifier: MIT
//
// The passes of a GL device in its trace. A GPU's times come from timestamps that are collected when they are there,
// without waiting. On a software renderer, whose timestamps miss most of the work, and where there are none, each pass
// is timed alone by the host's clock, between two waits for the device; the trace tells which of both it was.
#pragma once

#include <deque>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "assemble/region_layout.hpp"
#include "gl/timestamp.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/pass/pass.hpp"
#include "trace/trace.hpp"

namespace sk {

class PassTrace {
 public:
  /// A scope of the device is open, here and below.
  PassTrace(GlDevice& device, Trace& trace);

  void begin(PassRecord&& record);
  void end() noexcept;
  /// Puts passes in the trace whose times are known by now.
  void collect();
  /// Waits for all passes that are not in the trace yet.
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
  PassRecord record_;  ///< of the pass that is drawn
  Trace::Time begin_ = 0;  ///< of it, on the host
  std::deque<Timed> timed_;  ///< those that may not be done; the last one may not have ended
  std::vector<gl::Timestamp> idle_;
  Trace::Time calibrated_ = 0;
  Trace::Time hostAhead_ = 0;  ///< the host's clock over the device's
  Trace::Time lastEnd_ = 0;  ///< of the latest pass on the device's track
};

/// What a pass is called.
struct PassName {
  std::string_view kernel;
  std::string_view step = {};
  std::string_view kind = "draw";
};

/// Bytes that a pass writes for each texel, of all planes together.
std::size_t texelBytesOf(std::span<RenderTarget* const> planes);
std::size_t texelBytesOf(std::span<const RenderTarget> planes);

/// What a pass of a kernel's program over these texels, of so many bytes, reads and writes.
PassRecord recordOf(const PassName& name, const KernelProgram& program, std::span<const Operand> operands,
                    std::span<const assemble::Rect> rects, std::size_t texelBytes);
/// Of one that is known to read so many bytes and to write so many elements a texel.
PassRecord recordOf(const PassName& name, std::int64_t bytesRead, std::span<const assemble::Rect> rects,
                    std::size_t texelBytes, int elementsOfTexel = 1);
/// Of one that reads the whole of some planes.
PassRecord recordOf(const PassName& name, std::span<const RenderTarget> planes,
                    std::span<const assemble::Rect> rects, std::size_t texelBytes);

/// Of one that copies texels to a rectangle of the target.
PassRecord recordOf(const PassName& name, const assemble::Rect& rect, std::size_t texelBytes);

/// Of one that runs a kernel's program.
PassName nameOf(std::string_view kernel, std::string_view step, const KernelProgram& program);

/// What a kernel does in a pass, where that is not all of it.
std::string_view stepOf(const assemble::Task& task);

/// A pass for as long as this lives, traced and counted; nothing where the device does neither. Two do not overlap. After the
/// name come what recordOf() takes.
class PassScope {
 public:
  template <class... What>
  PassScope(GlDevice& device, const PassName& name, const What&... what) : trace_(device.passes.get()) {
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
