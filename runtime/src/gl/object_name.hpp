// SPDX-License-Identifier: MIT
//
// Owns the name of a GL object, which is deleted after its owner: the base of this folder's classes for GL
// objects. The context need not be current when an owner is destroyed (deletions.hpp), but it must outlive
// its owners.
#pragma once

#include <utility>

#include <epoxy/gl.h>

#include "gl/deletions.hpp"

namespace sk::gl {

/// `Delete` must also inform `bound` that the object is no longer bound.
template <void (*Delete)(BoundState& bound, GLuint name)>
class ObjectName {
 public:
  ObjectName() = default;
  /// Owns the result of make(), unless it is 0. Throws std::bad_alloc before anything is created.
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

/// Creates a name with glGenTextures or a similar function.
template <class Generate>
GLuint generated(Generate generate) {
  GLuint name = 0;
  generate(1, &name);
  return name;
}

}  // namespace sk::gl
