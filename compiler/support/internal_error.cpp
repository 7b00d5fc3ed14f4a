// SPDX-License-Identifier: MIT
#include "support/internal_error.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace skc {
namespace {

// A signal handler reads these: they have to outlive the stack, and to need no memory.
char activity[200] = "";
bool isPrinted = false;

}  // namespace

void internalError(std::string_view what) {
  std::fprintf(stderr, "skc: internal error: %.*s\n", static_cast<int>(what.size()), what.data());
  isPrinted = true;
  std::abort();
}

bool isInternalErrorPrinted() { return isPrinted; }

void noteActivity(std::string_view phase, std::string_view kernel) {
  const auto length = [](std::string_view text) {
    return static_cast<int>(std::min<std::size_t>(text.size(), 80));
  };
  if (kernel.empty()) {
    std::snprintf(activity, sizeof activity, "%.*s", length(phase), phase.data());
  } else {
    std::snprintf(activity, sizeof activity, "%.*s, kernel '%.*s'", length(phase), phase.data(),
                  length(kernel), kernel.data());
  }
}

const char* currentActivity() { return activity; }

}  // namespace skc
