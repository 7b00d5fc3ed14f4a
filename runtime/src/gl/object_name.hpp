// SPDX-License-Identifier: MIT
//
// The name of a GL object that is deleted with its owner: what the classes of this folder, one for
// each kind of GL object, are built on. The context must be current when an owner of a name dies.
#pragma once

#include <utility>

#include <epoxy/gl.h>

namespace sk::gl {

template <void (*Delete)(GLuint)>
class ObjectName {
 public:
  ObjectName() = default;
  explicit ObjectName(GLuint name) : name_(name) {}
  ObjectName(ObjectName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  ObjectName& operator=(ObjectName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~ObjectName() {
    if (name_ != 0) {
      Delete(name_);
    }
  }

  GLuint get() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

  /// Leaves the object to its context: for when that is out of reach, and takes it along as it dies.
  void forget() noexcept { name_ = 0; }

 private:
  GLuint name_ = 0;
};

}  // namespace sk::gl
