// SPDX-License-Identifier: MIT
//
// What `skc --library` adds to FILE.sk.cpp: a list of its descriptors, by which a program that loads them as a shared
// object finds them. Nothing that an application needs, whose stubs name theirs.
#pragma once

#include <span>

#include "sk/program.hpp"

namespace sk::program {

/// All kernels and reductions of a .sk file, in the order of their declaration. They live as long as the object is loaded.
struct Library {
  std::span<const Kernel* const> kernels = {};
  std::span<const Reduction* const> reductions = {};
};

/// The list of a shared object, which also one that hides its symbols shows, and its name for dlsym().
extern "C" [[gnu::visibility("default")]] const Library sk_library;
inline constexpr const char* librarySymbol = "sk_library";

}  // namespace sk::program
