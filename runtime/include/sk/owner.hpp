// SPDX-License-Identifier: MIT
//
// The owner of an object whose type only the runtime knows: std::unique_ptr without <memory>, which takes a compiler longer
// than all headers of StreamKernel together, in every file that includes them.
#pragma once

namespace sk::detail {

/// Move-only. Delete is called with the object when the owner ends, unless it owns none.
template <class State, class Delete>
class Owner {
 public:
  Owner() = default;
  explicit Owner(State* state) noexcept : state_(state) {}
  Owner(Owner&& other) noexcept : state_(other.release()) {}
  Owner& operator=(Owner&& other) noexcept {
    if (this != &other) reset(other.release());
    return *this;
  }
  ~Owner() { reset(nullptr); }

  State* get() const noexcept { return state_; }
  State& operator*() const noexcept { return *state_; }
  State* operator->() const noexcept { return state_; }
  explicit operator bool() const noexcept { return state_ != nullptr; }

  /// The object, which the caller then owns.
  State* release() noexcept {
    State* const state = state_;
    state_ = nullptr;
    return state;
  }

 private:
  void reset(State* state) noexcept {
    State* const old = state_;
    state_ = state;
    if (old != nullptr) Delete()(old);
  }

  State* state_ = nullptr;
};

}  // namespace sk::detail
