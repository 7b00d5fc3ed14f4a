// SPDX-License-Identifier: MIT
//
// What a call of the runtime throws, as text, for tests of its messages.
#pragma once

#include <string>

#include "sk/error.hpp"

/// The text of the sk::Error that `call` throws; "no error" where it throws none.
std::string errorOf(const auto& call) {
  try {
    call();
  } catch (const sk::Error& error) {
    return error.what();
  }
  return "no error";
}
