// SPDX-License-Identifier: MIT
//
// Dispatch over a std::variant with one lambda per alternative and no default: a new alternative is a compile
// error wherever it is not handled. (std::visit does the same, but with as many alternatives as the IR has
// nodes it takes several times as long to compile.)
#pragma once

#include <cstddef>
#include <utility>
#include <variant>

namespace skc {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

/// Calls `cases` with the alternative that `variant` holds; the alternatives before `Index` are ruled out.
template <std::size_t Index, class Variant, class Cases>
decltype(auto) matchFrom(Variant& variant, Cases& cases) {
  if constexpr (Index + 1 < std::variant_size_v<std::remove_const_t<Variant>>) {
    if (variant.index() != Index) return matchFrom<Index + 1>(variant, cases);
  }
  return cases(*std::get_if<Index>(&variant));
}

template <class Variant, class... F>
decltype(auto) match(Variant& variant, F&&... cases) {
  Overloaded all{std::forward<F>(cases)...};
  return matchFrom<0>(variant, all);
}

}  // namespace skc
