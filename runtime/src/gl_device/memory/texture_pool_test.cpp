// SPDX-License-Identifier: MIT
//
// Promises: idle textures stay as long as they take no more than a part of the device's memory, and go after a number of calls
// otherwise.
#include <cstddef>
#include <cstdint>
#include <utility>

#include <catch2/catch.hpp>

#include "gl/bound_state.hpp"
#include "gl/context.hpp"
#include "gl/format.hpp"
#include "gl/open_context.hpp"
#include "gl_device/memory/kept_bytes.hpp"
#include "gl_device/memory/render_target.hpp"

namespace sk {
namespace {

constexpr std::int64_t mebibyte = 1 << 20;

std::int64_t keptAfterManyCalls(std::size_t keptBytes) {
  const gl::Context context = gl::openContext({"software", gl::Api::Gl}).context;
  const gl::CurrentScope current(context);
  gl::BoundState bound;
  FramebufferCache framebuffers(bound);
  std::int64_t kept = 0;
  {
    TexturePool pool(bound, framebuffers, keptBytes);
    RenderTarget target = pool.acquire(gl::formatOf(program::Scalar::Float, 1), {1024, 1024, 0});
    REQUIRE(target);
    pool.release(std::move(target));
    for (int call = 0; call < 40; ++call) pool.trim();
    kept = pool.bytesKept();
  }
  bound.deleteQueued();
  return kept;
}

TEST_CASE("a pool keeps idle textures if they take little of the memory") {
  CHECK(keptAfterManyCalls(4 * mebibyte) == 4 * mebibyte);
  CHECK(keptAfterManyCalls(4 * mebibyte - 1) == 0);
}

TEST_CASE("a device keeps a part of a GPU's memory") {
  CHECK(keptBytesOf({}) == 256 * mebibyte);
  CHECK(keptBytesOf({.whole = 2048 * mebibyte, .available = {}}) == 256 * mebibyte);
  CHECK(keptBytesOf({.whole = 144 * 1024 * mebibyte, .available = {}}) == 9 * 1024 * mebibyte);
}

}  // namespace
}  // namespace sk
