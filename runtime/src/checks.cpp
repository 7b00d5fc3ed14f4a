// SPDX-License-Identifier: MIT
#include "checks.hpp"

#include <cstdlib>
#include <string_view>

namespace sk {

bool checksFolds() {
  static const bool checks = [] {
    const char* const value = std::getenv("SK_CHECK");
    return value != nullptr && std::string_view(value) == "folds";
  }();
  return checks;
}

}  // namespace sk
