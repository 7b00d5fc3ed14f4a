// SPDX-License-Identifier: MIT
#include "call/fold_check_setting.hpp"

#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk {

bool checksFolds() {
  static const bool checks = [] {
    const char* const value = std::getenv("SK_CHECK");
    if (value == nullptr || *value == '\0') return false;
    if (std::string_view(value) == "folds") return true;
    throw Error(fmt::format("there is no check '{}'; choose folds, or unset SK_CHECK", value));
  }();
  return checks;
}

}  // namespace sk
