// SPDX-License-Identifier: MIT
//
// Names of GL objects and of groups of commands, for debuggers (KHR_debug). Does nothing unless a debugger is
// attached.
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
  /// Names a texture, which must have been bound before.
  void texture(GLuint name, std::string_view label) const {
    if (isOn_) set(GL_TEXTURE, name, label);
  }

 private:
  static void set(GLenum kind, GLuint name, std::string_view label);

  bool isOn_ = false;
};

/// Groups all commands issued as long as this object lives.
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
