// SPDX-License-Identifier: MIT
//
// The members of bundles: structs of .sk files whose members are parameters of kernels. skc generates an aggregate of these
// types, which C++ passes as one argument:
//
//   Scene scene{.corner = corners, .view = {eye, 2.0f}, .spheres = true};
//   shade(scene, hits, colours);
//
// A member that is not given is empty. A call throws sk::Error if its kernel needs an empty member.
#pragma once

#include <concepts>
#include <optional>
#include <type_traits>
#include <utility>

#include "sk/call.hpp"

namespace sk {

namespace detail {

/// A stream, or what can be copied in its place: a view. Refers to a stream by its handle, so that it follows swaps.
class MemberRegion {
 public:
  MemberRegion() = default;
  template <class S>
  explicit MemberRegion(S&& stream) {
    using Handle = std::remove_cvref_t<S>;
    if constexpr (std::copyable<Handle>) {
      region_ = regionOfArgument(stream);
    } else {
      static_assert(
          std::is_lvalue_reference_v<S>,
          "StreamKernel: a bundle refers to this stream, which ends before it; give the stream a name");
      handle_ = &stream;
      regionOfHandle_ = [](const void* handle) {
        return regionOfArgument(*static_cast<const Handle*>(handle));
      };
    }
  }

  StreamRegion get() const { return handle_ != nullptr ? regionOfHandle_(handle_) : region_; }

 private:
  StreamRegion region_;
  const void* handle_ = nullptr;
  StreamRegion (*regionOfHandle_)(const void*) = nullptr;
};

/// Whether T{values...} makes a T of several values.
template <class T, class... Values>
concept MadeOf =
    sizeof...(Values) > 1 && requires(Values&&... values) { T{std::forward<Values>(values)...}; };

}  // namespace detail

/// A gather: any stream of T, to which it refers, or a view, which it copies.
template <class T>
class GatherMember {
 public:
  GatherMember() = default;
  GatherMember(None) {}
  template <StreamOf<T> S>
  GatherMember(S&& stream) : region_(std::forward<S>(stream)), isGiven_(true) {}
  Argument argument() const { return {.region = region_.get(), .isNone = !isGiven_}; }

 private:
  detail::MemberRegion region_;
  bool isGiven_ = false;
};

/// A uniform: a value, or a stream or view of one element, or an sk::Scalar, that holds it.
template <class T>
class UniformMember {
 public:
  UniformMember() = default;
  UniformMember(const T& value) : value_(value) {}
  template <class V>
    requires(std::is_arithmetic_v<V> && std::is_arithmetic_v<T> && !std::same_as<V, T>)
  UniformMember(V value) : value_(static_cast<T>(value)) {}
  /// `.view = {eye, 2.0f}`
  template <class... Values>
    requires detail::MadeOf<T, Values...>
  UniformMember(Values&&... values) : value_(T{std::forward<Values>(values)...}) {}
  template <StreamOf<T> S>
  UniformMember(S&& stream) : region_(std::forward<S>(stream)), isStream_(true) {}
  /// A pointer into this object, unless it is a stream.
  Argument argument() const {
    if (isStream_) return {.region = region_.get()};
    return {.value = value_ ? &*value_ : nullptr, .isNone = !value_};
  }

 private:
  std::optional<T> value_;
  detail::MemberRegion region_;
  bool isStream_ = false;
};

/// A specialisation constant.
template <class T>
class SpecMember {
 public:
  SpecMember() = default;
  SpecMember(T value) : value_(value) {}
  /// A pointer into this object.
  Argument argument() const { return {.value = value_ ? &*value_ : nullptr, .isNone = !value_}; }

 private:
  std::optional<T> value_;
};

}  // namespace sk
