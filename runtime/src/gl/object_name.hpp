// SPDX-License-Identifier: MIT
//
// Owners of GL objects, and the queue of objects whose owners have been destroyed. The objects are deleted when their
// context is current, so that owners may be destroyed anywhere, even while another context or none is current; but the
// context must outlive its owners. If it is never current again, its objects are deleted with it. The base of this folder's
// classes for GL objects.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

namespace sk::gl {

class BoundState;

class Deletions {
 public:
  using Delete = void (*)(BoundState& bound, std::uintptr_t object);

  /// Reserves room for one more object, before it is created, so that add() never allocates. Throws
  /// std::bad_alloc.
  void makeRoom() {
    const std::size_t needed = queued_.size() + living_ + 1;
    if (queued_.capacity() < needed) queued_.reserve(2 * needed);
  }
  /// Registers an object that has an owner from now on; there is room for it.
  void expect() noexcept { ++living_; }
  /// Queues an object whose owner is destroyed.
  void add(Delete how, std::uintptr_t object) noexcept {
    queued_.push_back({how, object});
    --living_;
  }

  /// Deletes the queued objects. Their context must be current.
  void run(BoundState& bound) noexcept {
    for (const Queued& one : queued_) one.how(bound, one.object);
    queued_.clear();
  }

 private:
  struct Queued {
    Delete how;
    std::uintptr_t object;
  };
  std::vector<Queued> queued_;
  std::size_t living_ = 0;
};

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
