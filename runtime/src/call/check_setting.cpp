// SPDX-License-Identifier: MIT
#include "call/check_setting.hpp"

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk {

namespace {

enum class Check : std::uint8_t { None, Folds, Halos, Written, Collectives };

Check chosenCheck() {
  static const Check chosen = [] {
    const char* const value = std::getenv("SK_CHECK");
    if (value == nullptr || *value == '\0') return Check::None;
    if (std::string_view(value) == "folds") return Check::Folds;
    if (std::string_view(value) == "halos") return Check::Halos;
    if (std::string_view(value) == "written") return Check::Written;
    if (std::string_view(value) == "collectives") return Check::Collectives;
    throw Error(fmt::format(
        "there is no check '{}'; choose folds, halos, written or collectives, or unset SK_CHECK", value));
  }();
  return chosen;
}

}  // namespace

bool checksFolds() { return chosenCheck() == Check::Folds; }
bool checksHalos() { return chosenCheck() == Check::Halos; }
bool checksWritten() { return chosenCheck() == Check::Written; }
bool checksCollectives() { return chosenCheck() == Check::Collectives; }

}  // namespace sk
