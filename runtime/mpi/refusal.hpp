// SPDX-License-Identifier: MIT
//
// An error of this rank that has been caught, because the other ranks have to
// hear of it before it is thrown.
#pragma once

#include <optional>
#include <string_view>
#include <utility>

#include "sk/error.hpp"

namespace sk::mpi {

/// Why this rank does not take part in a call; empty if it does.
using Refusal = std::optional<Error>;

/// The exception that is being handled, as an error. `what` names the call, for
/// an exception that does not. Allocates nothing if there is no memory.
Error currentError(std::string_view what) noexcept;

/// Calls fn(). Returns what it has thrown.
template <class Fn>
Refusal caught(std::string_view what, Fn&& fn) noexcept {
  try {
    std::forward<Fn>(fn)();
    return std::nullopt;
  } catch (...) {
    return currentError(what);
  }
}

}  // namespace sk::mpi
