// SPDX-License-Identifier: MIT
//
// The name of a GL object that is deleted after its owner has ended: what the classes of this folder, one for each kind of GL
// object, are built on. The context need not be current when an owner ends (deletions.hpp); it must not end before its owners.
#pragma once

#include <utility>

#include <epoxy/gl.h>

#include "gl/deletions.hpp"

namespace sk::gl {

/// `Delete` also tells `bound` that the object is bound nowhere any more.
template <void (*Delete)(BoundState& bound, GLuint name)>
class ObjectName {
 public:
  ObjectName() = default;
  /// Owns what make() gives, if that is not 0. Throws std::bad_alloc before anything is made.
  template <class Make>
  ObjectName(Deletions& deletions, Make&& make) : deletions_(&deletions) {
    deletions.makeRoom();
    name_ = make();
    if (name_ != 0) deletions.expect();
  }
  ObjectName(ObjectName&& other) noexcept
      : deletions_(other.deletions_), name_(std::exchange(other.name_, 0)) {}
  ObjectName& operator=(ObjectName&& other) noexcept {
    std::swap(deletions_, other.deletions_);
    std::swap(name_, other.name_);
    return *this;
  }
  ~ObjectName() {
    if (name_ != 0) deletions_->add(deleteObject, name_);
  }

  GLuint get() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  static void deleteObject(BoundState& bound, std::uintptr_t name) {
    Delete(bound, static_cast<GLuint>(name));
  }

  Deletions* deletions_ = nullptr;
  GLuint name_ = 0;
};

/// A name of glGenTextures and its like.
template <class Generate>
GLuint generated(Generate generate) {
  GLuint name = 0;
  generate(1, &name);
  return name;
}

}  // namespace sk::gl
