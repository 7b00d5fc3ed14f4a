// SPDX-License-Identifier: MIT
//
// Counts the linked .sk files. This is the program's only global state, because it records what was linked.
#include "sk/linked_file.hpp"

#include <atomic>

namespace sk::program {

namespace {

// Constant initialization makes these ready before the first stub. Libraries may be loaded on any thread.
constinit std::atomic<int> files = 0;
constinit std::atomic<int> filesWithGlsl = 0;
constinit std::atomic<int> filesWithNative = 0;

void count(LinkedFile::Code code, int change) noexcept {
  files += change;
  if (code.glsl) filesWithGlsl += change;
  if (code.native) filesWithNative += change;
}

}  // namespace

LinkedFile::LinkedFile(Code code) noexcept : code_(code) { count(code_, 1); }
LinkedFile::~LinkedFile() { count(code_, -1); }

LinkedFile::Code LinkedFile::ofAll() noexcept {
  const int all = files;
  return {.glsl = filesWithGlsl == all, .native = all > 0 && filesWithNative == all};
}

}  // namespace sk::program
