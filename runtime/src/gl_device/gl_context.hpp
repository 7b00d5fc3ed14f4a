// SPDX-License-Identifier: MIT
//
// The context of a GL device, with what is known of its state: what is bound, which errors the driver has reported, and which
// objects wait for their deletion.
#pragma once

#include <cassert>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "gl/bound_state.hpp"
#include "gl/capabilities.hpp"
#include "gl/context.hpp"
#include "gl/labels.hpp"
#include "gl/saved_state.hpp"

namespace sk {

/// Invariants: passes and transfers run only while a Scope is open, and there is one at a time. While none is open, a context that
/// the application draws in, too, has the application's state. All owners of GL objects are destroyed before the context.
class GlContext {
 public:
  /// `isShared`: the application draws in the device's own context. The capabilities must outlive this object.
  GlContext(gl::Context&& context, const gl::Capabilities& capabilities, bool isShared)
      : context_(std::move(context)),
        capabilities_(capabilities),
        isShared_(isShared),
        bound_(capabilities.api == gl::Api::Es) {}
  /// Deletes the objects whose owners have been destroyed. If the context cannot be made current, they are deleted with it.
  ~GlContext();

  const gl::Capabilities& capabilities() const { return capabilities_; }
  gl::BoundState& bound() { return bound_; }
  gl::Labels& labels() { return labels_; }

  /// Whether the application also draws in the context, so that each scope must restore its state.
  bool isGuest() const { return context_.isAdopted() || isShared_; }
  /// The context, lost or not.
  const gl::Context& handle() const { return context_; }
  /// The context. Throws sk::Error if it is known to be lost.
  const gl::Context& living() const {
    if (bound_.errors.isLost()) failAsLost();
    return context_;
  }
  /// Throws sk::Error if the context is lost. Queries the driver: call this after a failure that a lost
  /// context would explain.
  void throwIfLost();
  /// Throws sk::Error after a failure for want of memory for `what`, unless a lost context explains it.
  [[noreturn]] void failForMemory(std::string_view what);

  /// The number of the current period. Streams note in which one they were written: an error breaks those that were
  /// written since unchecked(), or since the period in which it can have begun.
  std::int64_t period() const { return period_; }
  /// The first period since the driver's errors were queried.
  std::int64_t unchecked() const { return unchecked_; }
  /// Begins a period, and returns its number.
  std::int64_t beginPeriod() { return ++period_; }
  /// Queries the driver's errors, and begins a period. Returns the driver's error if it concerns the streams that were written in it, else GL_NO_ERROR.
  GLenum takeError();

  class Scope;

 private:
  [[noreturn]] void failAsLost() const;

  gl::Context context_;
  const gl::Capabilities& capabilities_;
  const bool isShared_;
  gl::BoundState bound_;
  gl::Labels labels_;
  std::int64_t period_ = 1, unchecked_ = 1;
  bool isInScope_ = false;
};

/// Makes the context current and ready for passes as long as this object lives. There is one scope at a time: another one
/// would take the runtime's state for the application's.
class GlContext::Scope {
 public:
  explicit Scope(GlContext& context) : context_(context), current_(context.living()) {
    assert(!context.isInScope_);
    context.isInScope_ = true;
    if (context.isGuest()) context.bound_.errors.skipApplications();
    context.bound_.deleteQueued();
    if (context.isGuest()) saved_.emplace(context.capabilities_, context.bound_);
  }
  ~Scope() {
    saved_.reset();
    if (context_.isGuest()) context_.bound_.errors.setAside();  // the application shall not find them
    context_.isInScope_ = false;
  }
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;

 private:
  GlContext& context_;
  const gl::CurrentScope current_;
  std::optional<gl::SavedState> saved_;
};

}  // namespace sk
