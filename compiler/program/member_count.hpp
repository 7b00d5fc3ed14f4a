// SPDX-License-Identifier: MIT
//
// Counts the members of a descriptor at compile time, so that what prints descriptors can assert that it knows all of
// them. All that C++20 tells of the members of an aggregate is their number.
#pragma once

#include <cstddef>
#include <utility>

namespace skc::emit {

/// Stands for any member; only its type is used.
struct AnyMember {
  template <class T>
  operator T() const;
};

template <class T, std::size_t... I>
constexpr bool takes(std::index_sequence<I...>) {
  return requires { T{(static_cast<void>(I), AnyMember{})...}; };
}

/// The number of members of an aggregate without arrays and base classes.
template <class T, std::size_t Count = 0>
constexpr std::size_t memberCount() {
  if constexpr (takes<T>(std::make_index_sequence<Count + 1>{})) {
    return memberCount<T, Count + 1>();
  } else {
    return Count;
  }
}

}  // namespace skc::emit
