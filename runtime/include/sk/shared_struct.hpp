// SPDX-License-Identifier: MIT
//
// For generated stubs: checks that a struct of a header that C++ and .sk files share is the same for both.
#pragma once

#include <cstddef>
#include <type_traits>

namespace sk::detail {

/// True if a member of type T of the C++ struct holds what kernels take for a U. Enumerations are integers there.
template <class T, class U>
inline constexpr bool holds =
    std::is_same_v<T, U> || ((std::is_integral_v<T> || std::is_enum_v<T>) && std::is_integral_v<U> &&
                             !std::is_same_v<U, bool> && sizeof(T) == sizeof(U));
template <class T, class U, std::size_t Length>
inline constexpr bool holds<T[Length], U[Length]> = holds<T, U>;

}  // namespace sk::detail
