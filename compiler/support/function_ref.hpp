// SPDX-License-Identifier: MIT
//
// A non-owning reference to a callable. Tree walkers take one, so that they need not be templates.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace skc {

template <class Signature>
class FunctionRef;

/// Refers to anything that can be called with `Args`; the callable must outlive the reference.
template <class Result, class... Args>
class FunctionRef<Result(Args...)> {
 public:
  template <class F>
    requires(!std::is_same_v<std::remove_cvref_t<F>, FunctionRef>)
  FunctionRef(F&& function)  // NOLINT(google-explicit-constructor): a lambda is passed as it is
      : function_{const_cast<void*>(static_cast<const void*>(std::addressof(function)))},
        call_{[](void* object, Args... args) -> Result {
          return static_cast<Result>(
              (*static_cast<std::remove_reference_t<F>*>(object))(std::forward<Args>(args)...));
        }} {}

  Result operator()(Args... args) const { return call_(function_, std::forward<Args>(args)...); }

 private:
  void* function_;
  Result (*call_)(void*, Args...);
};

}  // namespace skc
