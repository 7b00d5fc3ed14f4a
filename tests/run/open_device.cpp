// SPDX-License-Identifier: MIT
//
// Opens a device, calls nothing, and prints the error if there is one.
#include <cstdio>

#include "sk/sk.hpp"

int main() {
  try {
    const sk::Device device = sk::Device::native();
    std::puts("no error");
  } catch (const sk::Error& error) {
    std::puts(error.what());
  }
  return 0;
}
