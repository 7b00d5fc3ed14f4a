// SPDX-License-Identifier: MIT
//
// gl::BoundState stays right when the driver gives a new object the name of a deleted one, as drivers may.
#include "gl/bound_state.hpp"

#include <type_traits>

#include <epoxy/gl.h>

#include <catch2/catch.hpp>

#include "gl/format.hpp"
#include "gl/texture.hpp"
#include "sk/sk.hpp"

using namespace sk;

namespace {

constexpr GLuint onlyName = 4711;

/// Makes a glGen* function return the same name for every object while it lives. The driver accepts that name, because
/// OpenGL ES lets an application choose names.
template <auto* place>
class OneName {
 public:
  OneName() : driver_(*place) {
    *place = [](GLsizei, GLuint* names) { *names = onlyName; };
  }
  ~OneName() { *place = driver_; }
  OneName(const OneName&) = delete;
  OneName& operator=(const OneName&) = delete;

 private:
  std::remove_pointer_t<decltype(place)> driver_;
};

bool isBound(GLenum binding, GLuint name) {
  GLint bound = 0;
  glGetIntegerv(binding, &bound);
  return bound == static_cast<GLint>(name);
}

}  // namespace

TEST_CASE("a texture and a framebuffer whose names others had are bound when they are made") {
  Device device(DeviceOptions{.profile = "essl300"});
  device.makeCurrent();
  const OneName<&epoxy_glGenTextures> textures;
  const OneName<&epoxy_glGenFramebuffers> framebuffers;
  gl::BoundState bound;
  const gl::Format& format = gl::formatOf(program::Scalar::Float, 1);
  for (int layers : {0, 0, 3, 3}) {
    const gl::DeletionScope deleted(bound);
    const gl::Texture texture(bound, format, {4, 4, layers});
    CHECK(isBound(layers == 0 ? GL_TEXTURE_BINDING_2D : GL_TEXTURE_BINDING_2D_ARRAY, onlyName));
    const GLuint names[] = {texture.name()};
    const gl::Framebuffer framebuffer(bound, names, layers > 0);
    CHECK(isBound(GL_DRAW_FRAMEBUFFER_BINDING, onlyName));
    CHECK(isBound(GL_READ_FRAMEBUFFER_BINDING, onlyName));
    CHECK(gl::Framebuffer::isComplete());
  }
}
