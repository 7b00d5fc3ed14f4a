// SPDX-License-Identifier: MIT
//
// Names for GL's objects and groups of commands, which debuggers show (KHR_debug). Nothing is named where nobody looks.
#pragma once

#include <string_view>

#include <epoxy/gl.h>

namespace sk::gl {

class Labels {
 public:
  void turnOn() { isOn_ = true; }
  bool isOn() const { return isOn_; }

  void program(GLuint name, std::string_view label) const {
    if (isOn_) set(GL_PROGRAM, name, label);
  }
  /// A texture that has been bound.
  void texture(GLuint name, std::string_view label) const {
    if (isOn_) set(GL_TEXTURE, name, label);
  }

 private:
  static void set(GLenum kind, GLuint name, std::string_view label);

  bool isOn_ = false;
};

/// A group of all commands for as long as this lives.
class LabelGroup {
 public:
  LabelGroup(const Labels& labels, std::string_view label) : isOn_(labels.isOn()) {
    if (isOn_) push(label);
  }
  ~LabelGroup() {
    if (isOn_) glPopDebugGroup();
  }
  LabelGroup(const LabelGroup&) = delete;
  LabelGroup& operator=(const LabelGroup&) = delete;

 private:
  static void push(std::string_view label);

  bool isOn_;
};

}  // namespace sk::gl
