// SPDX-License-Identifier: MIT
#include "gl_device/gl_context.hpp"

#include <exception>

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk {

GlContext::~GlContext() {
  try {
    const gl::CurrentScope current(context_);
    bound_.deleteQueued();
  } catch (const std::exception&) {
    return;
  }
}

void GlContext::failAsLost() const {
  throw Error(fmt::format("the driver has reset '{}', and all of its streams are lost; make a new device",
                          capabilities_.renderer),
              Error::Kind::Lost);
}

void GlContext::throwIfLost() {
  bound_.errors.setAside();
  if (bound_.errors.isLost() || (capabilities_.reportsResets && bound_.errors.askIfLost())) failAsLost();
}

void GlContext::failForMemory(std::string_view what) {
  throwIfLost();
  throw Error(fmt::format("'{}' has no memory for {}", capabilities_.renderer, what), Error::Kind::Memory);
}

// In a shared context, other errors than exhausted memory and a lost context may come of restoring what the application has
// deleted.
GLenum GlContext::takeError() {
  const GLenum error = bound_.errors.take();
  unchecked_ = beginPeriod();
  const bool isOurs = !isGuest() || error == GL_OUT_OF_MEMORY || error == GL_CONTEXT_LOST;
  return isOurs ? error : GL_NO_ERROR;
}

}  // namespace sk
