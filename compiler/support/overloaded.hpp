// SPDX-License-Identifier: MIT
//
// Dispatch over a std::variant with one lambda for each alternative and no default: a new
// alternative is a compile error wherever it is not handled.
#pragma once

#include <utility>
#include <variant>

namespace skc {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

template <class Variant, class... F>
decltype(auto) match(Variant&& variant, F&&... cases) {
  return std::visit(Overloaded{std::forward<F>(cases)...}, std::forward<Variant>(variant));
}

}  // namespace skc
