// SPDX-License-Identifier: MIT
//
// What the passes of all calls on a GL device share: the order between draws and dispatches, what every draw binds, the buffers
// that dispatches work on, and the trace.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include "gl/buffer.hpp"
#include "gl/commands.hpp"
#include "gl/texture.hpp"
#include "gl_device/gl_context.hpp"
#include "gl_device/memory/kept_scratch.hpp"
#include "gl_device/pass/loop_reports.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/program.hpp"

namespace sk {

class PassTrace;
class Trace;

/// The buffers that dispatches work on.
enum class PassBuffer : std::uint8_t {
  Values,  ///< values of dispatched reductions, for the host
  /// Partial results of the work groups of dispatches that fold beside outputs (assemble/reduce/group_fold.hpp). Each dispatch
  /// resets the first word to 0, so that a loop may repeat it.
  Folded,
  GroupStates,  ///< of dispatched append outputs
  TileResults,  ///< of scans in one pass
  SortedWords,  ///< of sorts, between two digits
};

/// What a dispatch writes for later commands.
enum class Writes : std::uint8_t {
  Texels,
  Storage,  ///< and a buffer
};

/// Invariants: a dispatch begins after whatever was drawn or copied before it, since it may overwrite what that still reads; what it
/// writes is visible to all later commands. Apart from PassBuffer::Folded, a buffer belongs to one call at a time.
class GlPasses {
 public:
  /// The context must outlive this object.
  explicit GlPasses(GlContext& context);
  ~GlPasses();

  /// Must be called when a call begins. Deletes large buffers that have been idle for a number of calls.
  void beginCall();

  /// Must be called before something is drawn.
  void beginDraw() {
    context_.bound().vertexArray(vertexArray_.name());
    hasDrawn_ = true;
  }
  /// Must be called before texels are copied by a command that is no draw.
  void beginCopy() { hasDrawn_ = true; }
  /// gl::blit(), a copy.
  void blit(GLuint from, gl::Corner source, GLuint to, gl::Corner target, GLsizei width, GLsizei height) {
    beginCopy();
    gl::blit(context_.bound(), from, source, to, target, width, height);
  }
  /// Runs work groups of the bound program.
  void dispatch(GLsizei groupsInX, GLsizei groupsInY, Writes writes = Writes::Texels) {
    orderAfterDraws();
    gl::dispatch(context_.bound(), groupsInX, groupsInY);
    if (writes == Writes::Storage) gl::finishStorage(context_.bound());
  }

  /// Whether something has been drawn or copied since the last dispatch. Code that repeats commands sets it to what it was after
  /// them.
  bool hasDrawn() const { return hasDrawn_; }
  void setDrawn(bool hasDrawn) { hasDrawn_ = hasDrawn; }
  /// Makes later dispatches begin after whatever has been drawn or copied.
  void orderAfterDraws() {
    if (std::exchange(hasDrawn_, false)) gl::finishDraws(context_.bound());
  }

  gl::Samplers& samplers() { return samplers_; }
  LoopReports& loopReports() { return loopReports_; }

  /// Binds a buffer with room for `bytes` bytes (gl::StorageBuffer::bind()); false if memory is exhausted.
  bool bind(PassBuffer which, std::size_t bytes) { return buffer(which).bind(context_.bound(), bytes); }
  /// Likewise. Throws sk::Error, which names the kernel and what the buffer is for, if memory is exhausted.
  void bind(PassBuffer which, std::size_t bytes, const program::Kernel& kernel, std::string_view whatFor);
  /// Reads what dispatches have written to the beginning of a buffer; waits for them.
  void read(PassBuffer which, std::span<std::byte> bytes) { buffer(which).read(context_.bound(), bytes); }

  /// The operands of a kernel's call.
  KeptScratch<Operand>& operands() { return operands_; }

  /// Null if there is no trace.
  PassTrace* trace() const { return trace_.get(); }
  void startTrace(Trace& trace);

 private:
  gl::StorageBuffer& buffer(PassBuffer which) { return buffers_[static_cast<std::size_t>(which)]; }

  GlContext& context_;
  const std::size_t keptBytes_;  ///< of a buffer that is idle
  bool hasDrawn_ = false;
  gl::VertexArray vertexArray_;
  gl::Samplers samplers_{context_.bound().deletions};
  std::array<gl::StorageBuffer, 5> buffers_{
      gl::StorageBuffer(gl::StorageBuffer::Use::Values),
      gl::StorageBuffer(gl::StorageBuffer::Use::Persistent),
      gl::StorageBuffer(gl::StorageBuffer::Use::Scratch), gl::StorageBuffer(gl::StorageBuffer::Use::Scratch),
      gl::StorageBuffer(gl::StorageBuffer::Use::Scratch)};  ///< by PassBuffer
  LoopReports loopReports_;
  KeptScratch<Operand> operands_;
  std::unique_ptr<PassTrace> trace_;
};

}  // namespace sk
