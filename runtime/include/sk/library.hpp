// SPDX-License-Identifier: MIT
//
// What `skc --library` adds to FILE.sk.cpp: a list of its descriptors for programs that load the file as a
// shared object. Applications do not need it, because their stubs name the descriptors.
#pragma once

#include <span>

#include "sk/program.hpp"

namespace sk::program {

/// All kernels and reductions of a .sk file, in order of declaration. Valid as long as the shared object is
/// loaded.
struct Library {
  std::span<const Kernel* const> kernels = {};
  std::span<const Reduction* const> reductions = {};
};

/// The shared object's list, exported even if the object hides its symbols, and its name for dlsym().
extern "C" [[gnu::visibility("default")]] const Library sk_library;
inline constexpr const char* librarySymbol = "sk_library";

}  // namespace sk::program
