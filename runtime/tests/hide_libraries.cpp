// SPDX-License-Identifier: MIT
//
// Preloaded into a test: makes dlopen fail for the libraries that SK_TEST_HIDE lists, separated by ':', as if they were not
// installed.
#include <dlfcn.h>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

bool isHidden(const char* name) {
  const char* list = std::getenv("SK_TEST_HIDE");
  if (list == nullptr || name == nullptr) {
    return false;
  }
  const std::string entry = std::string(":") + name + ":";
  return (std::string(":") + list + ":").find(entry) != std::string::npos;
}

}  // namespace

extern "C" void* dlopen(const char* name, int flags) {
  using Open = void* (*)(const char*, int);
  static const auto original = reinterpret_cast<Open>(dlsym(RTLD_NEXT, "dlopen"));
  return isHidden(name) ? original((std::string("/nonexistent/") + name).c_str(), flags)
                        : original(name, flags);
}
