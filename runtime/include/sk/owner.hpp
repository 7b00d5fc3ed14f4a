// SPDX-License-Identifier: MIT
//
// Owns an object of a type that only the runtime defines. Replaces std::unique_ptr, because <memory> takes a
// compiler longer than all headers of StreamKernel together, in every file that includes them.
#pragma once

namespace sk::detail {

/// Move-only. The destructor calls Delete with the object, if there is one. Delete::moved, if it exists, is called
/// with the object and its new owner.
template <class State, class Delete>
class Owner {
 public:
  Owner() = default;
  explicit Owner(State* state) noexcept : state_(state) { notify(); }
  Owner(Owner&& other) noexcept : state_(other.release()) { notify(); }
  Owner& operator=(Owner&& other) noexcept {
    if (this != &other) reset(other.release());
    return *this;
  }
  ~Owner() { reset(nullptr); }

  State* get() const noexcept { return state_; }
  State& operator*() const noexcept { return *state_; }
  State* operator->() const noexcept { return state_; }
  explicit operator bool() const noexcept { return state_ != nullptr; }

  /// Gives up ownership of the object and returns it.
  State* release() noexcept {
    State* const state = state_;
    state_ = nullptr;
    return state;
  }

 private:
  void reset(State* state) noexcept {
    State* const old = state_;
    state_ = state;
    notify();
    if (old != nullptr) Delete()(old);
  }

  void notify() noexcept {
    if constexpr (requires { Delete::moved(state_, this); }) {
      if (state_ != nullptr) Delete::moved(state_, this);
    }
  }

  State* state_ = nullptr;
};

}  // namespace sk::detail
