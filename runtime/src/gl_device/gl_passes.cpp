// SPDX-License-Identifier: MIT
#include "gl_device/gl_passes.hpp"

#include "call/check_call.hpp"
#include "gl_device/memory/kept_bytes.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "support/checked_size.hpp"

namespace sk {

GlPasses::GlPasses(GlContext& context)
    : context_(context), keptBytes_(keptBytesOn(context.handle(), context.capabilities())) {
  const gl::CurrentScope current(context.handle());
  vertexArray_ = gl::VertexArray(context.bound().deletions);
}

GlPasses::~GlPasses() = default;

void GlPasses::beginCall() {
  if (context_.isGuest()) hasDrawn_ = true;  // by the application
  for (const PassBuffer scratch : {PassBuffer::GroupStates, PassBuffer::TileResults, PassBuffer::SortedWords})
    buffer(scratch).trim(keptBytes_);
}

void GlPasses::bind(PassBuffer which, std::size_t bytes, const program::Kernel& kernel,
                    std::string_view whatFor) {
  if (bind(which, bytes)) return;
  context_.throwIfLost();
  fail(Error::Kind::Memory, kernel, "'{}' has no memory for {}: a buffer of {}",
       context_.capabilities().renderer, whatFor, bytesText(static_cast<std::int64_t>(bytes)));
}

void GlPasses::startTrace(Trace& trace) { trace_ = std::make_unique<PassTrace>(context_, trace); }

}  // namespace sk
