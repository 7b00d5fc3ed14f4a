// SPDX-License-Identifier: MIT
//
// The little of GL that hand-written passes need: float textures, programs of one fragment shader, and tasks whose
// context is current while they work. It must not use the runtime.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include "contender.hpp"
#include "plain_context.hpp"

namespace race {

/// A texture of 1 or 4 floats a texel, also as a target to draw to.
class Texture {
 public:
  /// `texels`: row by row, or null. Throws std::runtime_error where the device has no such texture.
  Texture(std::int64_t width, std::int64_t height, int channels, const float* texels);
  ~Texture();
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  GLuint name() const { return name_; }
  int width() const { return width_; }
  int height() const { return height_; }
  void bindAsTarget() const;
  std::vector<float> read() const;

 private:
  int width_, height_, channels_;
  GLuint name_ = 0;
  GLuint framebuffer_ = 0;
};

/// A fragment shader, for which samplers s0, s1 ... are the textures that draw() is given.
class PassProgram {
 public:
  explicit PassProgram(const std::string& text);
  ~PassProgram();
  PassProgram(const PassProgram&) = delete;
  PassProgram& operator=(const PassProgram&) = delete;

  /// Runs it for every texel of the target.
  void draw(const Texture& target, const std::vector<const Texture*>& inputs) const;

 private:
  GLuint name_ = 0;
  GLuint array_ = 0;
};

/// A task whose passes are made, drawn and let go with the context current. `Passes` has draw() and result().
template <class Passes>
class GlTask final : public Task {
 public:
  template <class... Arguments>
  explicit GlTask(const bench::PlainContext& context, Arguments&&... arguments) : context_(context) {
    const bench::PlainContext::Current current(context_);
    passes_ = std::make_unique<Passes>(std::forward<Arguments>(arguments)...);
  }
  ~GlTask() override {
    const bench::PlainContext::Current current(context_);
    passes_.reset();
  }

  void run(int times) override {
    const bench::PlainContext::Current current(context_);
    for (int i = 0; i < times; ++i) passes_->draw();
    glFinish();
  }
  std::vector<float> result() override {
    const bench::PlainContext::Current current(context_);
    return passes_->result();
  }

 private:
  const bench::PlainContext& context_;
  std::unique_ptr<Passes> passes_;
};

}  // namespace race
