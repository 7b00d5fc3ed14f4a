// SPDX-License-Identifier: MIT
#include "support/window.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace examples {
namespace {

[[noreturn]] void fail(const std::string& what) {
  const char* description = nullptr;
  glfwGetError(&description);
  throw std::runtime_error(fmt::format("{}: {}; leave --window out to write pictures instead", what,
                                       description != nullptr ? description : "GLFW says no more"));
}

GLFWwindow* open(const std::string& title, int width, int height) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SAMPLES, 4);
  GLFWwindow* window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window == nullptr) fail("no window with OpenGL 3.3 can be opened");
  return window;
}

}  // namespace

Window::Library::Library() {
  if (glfwInit() != GLFW_TRUE) fail("no window can be opened");
}
Window::Library::~Library() { glfwTerminate(); }

void Window::Closer::operator()(GLFWwindow* window) const noexcept { glfwDestroyWindow(window); }

Window::Window(const std::string& title, int width, int height) : window_(open(title, width, height)) {
  GLFWwindow* window = window_.get();
  glfwMakeContextCurrent(window);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window, this);
  glfwSetCharCallback(window, [](GLFWwindow* of, unsigned character) {
    auto& self = *static_cast<Window*>(glfwGetWindowUserPointer(of));
    if (character == 'q') glfwSetWindowShouldClose(of, GLFW_TRUE);
    if (character == ' ') self.isPaused_ = !self.isPaused_;
    if (character < 128) self.input_.typed += static_cast<char>(character);
  });
  glfwSetKeyCallback(window, [](GLFWwindow* of, int key, int, int action, int) {
    if (key == GLFW_KEY_ESCAPE && action == GLFW_PRESS) glfwSetWindowShouldClose(of, GLFW_TRUE);
  });
  glfwSetScrollCallback(window, [](GLFWwindow* of, double, double notches) {
    static_cast<Window*>(glfwGetWindowUserPointer(of))->input_.wheel += notches;
  });
}

Window::~Window() = default;

sk::Device Window::device(const std::string& name) {
  const bool isHosted = name == "native" || name.starts_with("reference");
  return isHosted ? sk::Device(name) : sk::Device::adopt();
}

bool Window::isOpen() const { return glfwWindowShouldClose(window_.get()) == GLFW_FALSE; }
void Window::setTitle(const std::string& title) {
  glfwSetWindowTitle(window_.get(), (title + (isPaused_ ? ", paused" : "")).c_str());
}

std::optional<Window::Size> Window::size() const {
  Size size{};
  glfwGetFramebufferSize(window_.get(), &size.width, &size.height);
  return size.width > 0 && size.height > 0 ? std::optional(size) : std::nullopt;
}

Input Window::show() {
  GLFWwindow* window = window_.get();
  glfwSwapBuffers(window);
  glfwPollEvents();
  Input input = std::exchange(input_, {});
  if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
    double x = 0, y = 0;
    glfwGetCursorPos(window, &x, &y);
    const auto [fromX, fromY] = dragFrom_.value_or(std::pair{x, y});
    input.isDragged = true;
    input.dragX = x - fromX;
    input.dragY = y - fromY;
    dragFrom_ = {x, y};
  } else {
    dragFrom_.reset();
  }
  return input;
}

}  // namespace examples
