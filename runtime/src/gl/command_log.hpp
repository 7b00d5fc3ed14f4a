// SPDX-License-Identifier: MIT
//
// The GL commands of an iteration of a loop, kept in order to give them again. While a BoundState has a log, every
// function of this folder that draws, dispatches, binds or sets a uniform notes itself in it; all other commands spoil
// the log. A log refers to GL objects by name, and goes stale when one of them is deleted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include <epoxy/gl.h>

namespace sk::gl {

class BoundState;
class WideUniform;
class FieldUniform;
class IntUniform;

/// A command, or a binding that later commands need.
struct Command {
  enum class Kind : std::uint8_t {
    Program,
    VertexArray,
    Texture,
    ArrayTexture,
    Sampler,
    Image,
    Storage,  ///< a buffer that programs read and write
    LoopStorage,  ///< that of a LoopCheck
    Framebuffer,  ///< for drawing and reading
    Viewport,
    Ints,
    Field,
    Wide,
    Draw,  ///< of the viewport
    Dispatch,
    FinishDraws,
  };
  Kind kind;
  GLint unit = 0;
  GLuint name = 0;
  GLenum format = 0;  ///< of an image
  void* uniform = nullptr;
  std::size_t bytes = 0, size = 0;  ///< Field, Wide: where the value is in the log's bytes
  std::array<GLint, 4> numbers{};  ///< the rectangle, the value or the numbers of work groups
};

/// Where the counts of draws and dispatches lie in a buffer of indirect commands (loop_gate.hpp).
struct IndirectCounts {
  GLintptr draw = 0;
  GLintptr dispatches = 0;  ///< of the first one's; each has dispatchBytes
  static constexpr GLintptr dispatchBytes = 3 * sizeof(GLuint);
};

class CommandLog {
 public:
  using Groups = std::array<GLint, 2>;  ///< the work groups of a dispatch in x and y

  CommandLog() = default;
  CommandLog(const CommandLog&) = delete;
  CommandLog& operator=(const CommandLog&) = delete;

  void note(const Command& command) { commands_.push_back(command); }
  void note(FieldUniform& uniform, std::span<const std::byte> value);
  void note(WideUniform& uniform, double value);

  /// Something has been done that the log does not hold.
  void spoil() noexcept { isSpoiled_ = true; }
  bool isSpoiled() const { return isSpoiled_; }

  /// Must be called for deleted objects.
  void forgetProgram(GLuint name) noexcept { forget(name, {Command::Kind::Program}); }
  void forgetTexture(GLuint name) noexcept {
    forget(name, {Command::Kind::Texture, Command::Kind::ArrayTexture, Command::Kind::Image});
  }
  void forgetFramebuffer(GLuint name) noexcept { forget(name, {Command::Kind::Framebuffer}); }
  void forgetStorage(GLuint name) noexcept {
    forget(name, {Command::Kind::Storage, Command::Kind::LoopStorage});
  }
  /// Whether an object that a command refers to has been deleted.
  bool isStale() const { return isStale_; }

  /// Gives the commands again, except bindings and uniforms that are as they should be.
  void run(BoundState& bound) const { giveAll(bound, commands_, nullptr); }
  /// Like run(), with the counts of draws and dispatches from a buffer, which must be bound. setGroups() must have been
  /// called.
  void runIndirect(BoundState& bound, const IndirectCounts& counts) const {
    giveAll(bound, commands_, &counts);
  }
  /// Like run(), directly after a run of the logs of a whole cycle.
  void runAgain(BoundState& bound) const { giveAll(bound, changes_, nullptr); }

  /// Prepares runAgain() for logs that run one after the other, and the first one again after the last.
  static void findChanges(std::span<CommandLog* const> cycle);
  /// Numbers the dispatches by their groups, of which it adds those that are not in `all` yet.
  void setGroups(std::vector<Groups>& all);

 private:
  void note(Command::Kind kind, void* uniform, std::span<const std::byte> value);
  void forget(GLuint name, std::initializer_list<Command::Kind> kinds) noexcept;
  void giveAll(BoundState& bound, std::span<const Command> commands, const IndirectCounts* counts) const;
  void give(BoundState& bound, const Command& command, const IndirectCounts* counts) const;
  bool isSame(const Command& a, const Command& b, const CommandLog& ofB) const;

  std::vector<Command> commands_;
  std::vector<Command> changes_;  ///< those of commands_ that do something in a cycle
  std::vector<std::byte> bytes_;  ///< the values of Field and Wide
  bool isSpoiled_ = false;
  bool isStale_ = false;
};

}  // namespace sk::gl
