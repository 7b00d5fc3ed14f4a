// SPDX-License-Identifier: MIT
//
// Tracks a context's bindings, so that nothing is bound twice, its errors, and its objects to be deleted. All
// bindings go through this class: code that binds directly must call forget(). In an adopted context, it also
// saves the application's bindings on the texture units that it uses, and restores them.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include "gl/command_log.hpp"
#include "gl/errors.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

/// The number of texture units that may be used: no known context has more for a fragment program.
inline constexpr int maxTextureUnits = 32;
/// The number of images that a compute program may write: the number of a draw's targets.
inline constexpr int maxImageUnits = 16;

class BoundState {
 public:
  /// `isEs`: the context is one of OpenGL ES.
  explicit BoundState(bool isEs = false) : isEs_(isEs) {}
  BoundState(const BoundState&) = delete;
  BoundState& operator=(const BoundState&) = delete;

  bool isEs() const { return isEs_; }

  void program(GLuint name) {
    note({.kind = Command::Kind::Program, .name = name});
    if (program_ != name) {
      glUseProgram(name);
      program_ = name;
    }
  }
  void vertexArray(GLuint name) {
    note({.kind = Command::Kind::VertexArray, .name = name});
    if (vertexArray_ != name) {
      glBindVertexArray(name);
      vertexArray_ = name;
    }
  }
  /// Array textures have a separate binding on each unit.
  void texture(int unit, GLuint name, bool isArray) {
    note(
        {.kind = isArray ? Command::Kind::ArrayTexture : Command::Kind::Texture, .unit = unit, .name = name});
    if ((isArray ? arrayTextures_ : textures_)[static_cast<std::size_t>(unit)] != name) {
      bindTexture(unit, name, isArray);
    }
  }
  /// Binds a sampler; 0 uses the texture's own settings. The texture must be bound first.
  void sampler(int unit, GLuint name) {
    note({.kind = Command::Kind::Sampler, .unit = unit, .name = name});
    if (samplers_[static_cast<std::size_t>(unit)] != name) {
      bindSampler(unit, name);
    }
  }
  /// Binds all layers of a texture as an image that programs write.
  void image(int unit, GLuint name, GLenum format) {
    note({.kind = Command::Kind::Image, .unit = unit, .name = name, .format = format});
    if (images_[static_cast<std::size_t>(unit)] != name) {
      bindImage(unit, name, format, GL_WRITE_ONLY);
      images_[static_cast<std::size_t>(unit)] = name;
    }
  }
  /// Binds all layers of a texture as an image that programs read and write, with a format of the same size.
  void readWriteImage(int unit, GLuint name, GLenum format) {
    spoil();
    bindImage(unit, name, format, GL_READ_WRITE);
    images_[static_cast<std::size_t>(unit)] = unknown;
  }
  /// Binds the buffer that programs write, at binding 0 and at the generic binding, through which its bytes
  /// are read.
  void storage(GLuint name) {
    spoil();
    if (storage_ != name) {
      bindStorage(name);
    }
  }
  /// Likewise, a buffer that keeps its bytes between calls, so that a log may bind it again.
  void keptStorage(GLuint name) {
    note({.kind = Command::Kind::Storage, .name = name});
    if (storage_ != name) {
      bindStorage(name);
    }
  }
  /// Binds the buffer of LoopCheck at binding 1, and leaves the generic binding as it is.
  void loopStorage(GLuint name) {
    note({.kind = Command::Kind::LoopStorage, .name = name});
    if (loopStorage_ != name) bindLoopStorage(name);
  }
  /// Calls `use` while a buffer is at the generic binding, through which its bytes are read.
  template <class Use>
  void withSelected(GLuint name, Use&& use) {
    keepStorage();
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, name);
    use();
    reselectStorage();
  }
  /// Binds a texture for changes by glTexSubImage2D and similar functions: on unit 0, which becomes the active
  /// one.
  void textureToChange(GLuint name, bool isArray) {
    activateUnit(0);
    texture(0, name, isArray);
  }
  /// Binds a framebuffer for drawing and reading.
  void framebuffer(GLuint name) {
    note({.kind = Command::Kind::Framebuffer, .name = name});
    if (drawFramebuffer_ != name || readFramebuffer_ != name) {
      glBindFramebuffer(GL_FRAMEBUFFER, name);
      drawFramebuffer_ = readFramebuffer_ = name;
    }
  }
  void drawFramebuffer(GLuint name);
  void readFramebuffer(GLuint name);
  void viewport(GLint x, GLint y, GLsizei width, GLsizei height) {
    const std::array<GLint, 4> wanted{x, y, width, height};
    note({.kind = Command::Kind::Viewport, .numbers = wanted});
    if (viewport_ != wanted) {
      setViewport(wanted);
      viewport_ = wanted;
    }
  }

  /// Invalidates everything that is known about bindings.
  void forget();
  /// Must be called for deleted objects: their bindings end, and the driver may reuse their names.
  void forgetProgram(GLuint name);
  void forgetTexture(GLuint name);
  void forgetFramebuffer(GLuint name);
  void forgetStorage(GLuint name);

  /// Deletes the objects whose owners have been destroyed. The context must be current.
  void deleteQueued() noexcept { deletions.run(*this); }

  /// Begins work in an application's context: saves a unit's texture and sampler when it is first used, and
  /// sets only the first of several viewports.
  void enterApplication(bool hasManyViewports);
  /// Restores what was saved, and the active unit `activeUnit`.
  void leaveApplication(GLint activeUnit);

  /// Notes all later commands in a log; null: in none. Returns the log before.
  CommandLog* logTo(CommandLog* log) noexcept { return std::exchange(log_, log); }
  bool isLogged() const noexcept { return log_ != nullptr; }
  void note(const Command& command) {
    if (log_ != nullptr) log_->note(command);
  }
  template <class Uniform, class Value>
  void note(Uniform& uniform, const Value& value) {
    if (log_ != nullptr) log_->note(uniform, value);
  }
  /// Must be called for each command that has no Command.
  void spoil() noexcept {
    if (log_ != nullptr) log_->spoil();
  }
  /// A log that shall learn which objects are deleted, until drop().
  void keep(CommandLog& log) { kept_.push_back(&log); }
  void drop(CommandLog& log) noexcept { std::erase(kept_, &log); }

  Errors errors;
  Deletions deletions;

 private:
  void bindTexture(int unit, GLuint name, bool isArray);
  void bindSampler(int unit, GLuint name);
  void bindImage(int unit, GLuint name, GLenum format, GLenum access);
  void keepImage(std::size_t unit);
  void bindStorage(GLuint name);
  void bindLoopStorage(GLuint name);
  void reselectStorage();
  void keepStorage();
  void restoreStorage();
  void activateUnit(int unit);
  void keepUnit(std::size_t unit);
  void setViewport(const std::array<GLint, 4>& rectangle) const;

  struct KeptUnit {
    bool kept = false;
    GLint texture = 0;
    GLint arrayTexture = 0;
    GLint sampler = 0;
  };
  struct KeptImage {
    bool kept = false;
    GLint name = 0, level = 0, isLayered = 0, layer = 0, access = 0, format = 0;
  };
  struct KeptRange {
    GLint name = 0;
    GLint64 start = 0, size = 0;  ///< a size of 0 stands for the whole buffer
  };
  struct KeptStorage {
    bool kept = false, isLoopsKept = false;
    GLint selected = 0;
    KeptRange first, loops;  ///< at bindings 0 and 1
  };
  static KeptRange rangeAt(GLuint binding);
  static void restoreAt(GLuint binding, const KeptRange& range);
  // No object has this name, so that the next binding is never skipped.
  static constexpr GLuint unknown = ~GLuint{0};
  template <std::size_t count = maxTextureUnits>
  static constexpr std::array<GLuint, count> unknownUnits() {
    std::array<GLuint, count> units;
    units.fill(unknown);
    return units;
  }

  const bool isEs_;
  CommandLog* log_ = nullptr;
  std::vector<CommandLog*> kept_;
  GLuint program_ = unknown;
  GLuint vertexArray_ = unknown;
  GLuint drawFramebuffer_ = unknown;
  GLuint readFramebuffer_ = unknown;
  std::array<GLint, 4> viewport_{-1, -1, -1, -1};
  int activeUnit_ = -1;
  std::array<GLuint, maxTextureUnits> textures_ = unknownUnits();
  std::array<GLuint, maxTextureUnits> arrayTextures_ = unknownUnits();
  std::array<GLuint, maxTextureUnits> samplers_ = unknownUnits();
  std::array<GLuint, maxImageUnits> images_ = unknownUnits<maxImageUnits>();
  GLuint storage_ = unknown;
  GLuint loopStorage_ = unknown;
  bool isApplications_ = false;
  bool hasManyViewports_ = false;
  std::array<KeptUnit, maxTextureUnits> keptUnits_{};
  std::array<KeptImage, maxImageUnits> keptImages_{};
  KeptStorage keptStorage_;
};

/// Leaves commands out of the log whose effect lasts, as long as this object lives.
class UnloggedScope {
 public:
  explicit UnloggedScope(BoundState& bound) : bound_(bound), log_(bound.logTo(nullptr)) {}
  ~UnloggedScope() { bound_.logTo(log_); }
  UnloggedScope(const UnloggedScope&) = delete;
  UnloggedScope& operator=(const UnloggedScope&) = delete;

 private:
  BoundState& bound_;
  CommandLog* log_;
};

/// Deletes, at its end, the objects whose owners were destroyed in this scope. The context must be current.
class DeletionScope {
 public:
  explicit DeletionScope(BoundState& bound) : bound_(bound) {}
  ~DeletionScope() { bound_.deleteQueued(); }
  DeletionScope(const DeletionScope&) = delete;
  DeletionScope& operator=(const DeletionScope&) = delete;

 private:
  BoundState& bound_;
};

}  // namespace sk::gl
