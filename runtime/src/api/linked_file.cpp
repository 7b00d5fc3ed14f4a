// SPDX-License-Identifier: MIT
//
// The count of linked .sk files. It is the only state that belongs to the whole program: linking is what it records.
#include "sk/linked_file.hpp"

#include <atomic>

namespace sk::program {

namespace {

// Constant initialization: they are ready before the first stub is. Libraries may be loaded on any thread.
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
