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

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "sk/call.hpp"

namespace sk {

namespace detail {

/// A stream, or what can be copied in its place: a view. Refers to a stream by its handle, so that it follows swaps; keeps one that
/// is a temporary.
class MemberRegion {
 public:
  MemberRegion() = default;
  template <class S>
  explicit MemberRegion(S&& stream) {
    using Handle = std::remove_cvref_t<S>;
    if constexpr (std::copyable<Handle>) {
      region_ = regionOfArgument(stream);
    } else {
      if constexpr (std::is_lvalue_reference_v<S>) {
        handle_ = &stream;
      } else {
        kept_ = std::make_shared<const Handle>(std::move(stream));
        handle_ = kept_.get();
      }
      regionOfHandle_ = [](const void* handle) {
        return regionOfArgument(*static_cast<const Handle*>(handle));
      };
    }
  }

  StreamRegion get() const { return handle_ != nullptr ? regionOfHandle_(handle_) : region_; }

 private:
  StreamRegion region_;
  const void* handle_ = nullptr;
  std::shared_ptr<const void> kept_;
  StreamRegion (*regionOfHandle_)(const void*) = nullptr;
};

template <class T, class... Values>
concept MadeInBraces = requires(Values&&... values) { T{std::forward<Values>(values)...}; };
/// Whether several values make a T.
template <class T, class... Values>
concept MadeOf = sizeof...(Values) > 1 &&
                 (MadeInBraces<T, Values...> || std::constructible_from<T, Values...>);
/// Makes it. Parentheses also convert: an int to a component of a float3.
template <class T, class... Values>
T madeOf(Values&&... values) {
  if constexpr (MadeInBraces<T, Values...>) {
    return T{std::forward<Values>(values)...};
  } else {
    return T(std::forward<Values>(values)...);
  }
}

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
  UniformMember(Values&&... values) : value_(detail::madeOf<T>(std::forward<Values>(values)...)) {}
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

/// A uniform array, of the elements of an std::array, a C array, an std::span or a list.
template <class E, std::size_t N>
class UniformMember<std::array<E, N>> {
 public:
  UniformMember() = default;
  UniformMember(const E (&values)[N]) { assign(values); }
  template <class Values>
    requires std::constructible_from<std::span<const E, N>, const Values&>
  UniformMember(const Values& values) {
    assign(std::span<const E, N>(values));
  }
  template <class... Values>
    requires(N > 1 && sizeof...(Values) == N && (std::convertible_to<Values, E> && ...))
  UniformMember(Values&&... values) : values_(std::array<E, N>{static_cast<E>(values)...}) {}
  /// A pointer into this object.
  Argument argument() const { return {.value = values_ ? values_->data() : nullptr, .isNone = !values_}; }

 private:
  template <class Values>
  void assign(const Values& values) {
    values_.emplace();
    std::copy(std::begin(values), std::end(values), values_->begin());
  }

  std::optional<std::array<E, N>> values_;
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
