// SPDX-License-Identifier: MIT
//
// The text of the error that a call of the runtime throws, for tests of messages.
#pragma once

#include <string>

#include "sk/error.hpp"

/// The text of the sk::Error that `call` throws; "no error" if it throws none.
std::string errorOf(const auto& call) {
  try {
    call();
  } catch (const sk::Error& error) {
    return error.what();
  }
  return "no error";
}
