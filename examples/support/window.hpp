// SPDX-License-Identifier: MIT
//
// A window with an OpenGL context that is current while it lives, by GLFW. It draws nothing itself.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <sk/sk.hpp>

struct GLFWwindow;

namespace examples {

/// What a person does in a window, since it was last asked.
struct Input {
  std::string typed;  ///< characters, in order
  bool isDragged = false;  ///< with the left button
  double dragX = 0, dragY = 0;  ///< pixels that the mouse was dragged
  double wheel = 0;  ///< notches, away from oneself is positive
};

class Window {
 public:
  /// Opens a window of this size in screen coordinates, OpenGL 3.3 core (or 4.x, where there is that), 4 samples a pixel.
  /// Throws std::runtime_error where there is no display, or none that has OpenGL.
  Window(const std::string& title, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// The device of this name if it computes on the host, native or reference; else the window's own OpenGL.
  static sk::Device device(const std::string& name);

  /// Until somebody closes it, by q or Escape, too.
  bool isOpen() const;
  /// Whether somebody has stopped it: space stops and goes on.
  bool isPaused() const { return isPaused_; }
  void pause() { isPaused_ = true; }
  /// Shows what was drawn, waits for the screen, and looks what was done meanwhile.
  Input show();
  /// Says also whether it is paused.
  void setTitle(const std::string& title);

  struct Size {
    int width, height;
  };
  /// The size of the framebuffer in pixels, which changes with the window; none while there is nothing to draw to.
  std::optional<Size> size() const;

 private:
  struct Library {  ///< GLFW itself
    Library();
    ~Library();
  };

  Library library_;
  Input input_;
  bool isPaused_ = false;
  std::optional<std::pair<double, double>> dragFrom_;
  struct Closer {
    void operator()(GLFWwindow* window) const noexcept;
  };
  std::unique_ptr<GLFWwindow, Closer> window_;
};

}  // namespace examples
