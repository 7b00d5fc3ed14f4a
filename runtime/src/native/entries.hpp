// SPDX-License-Identifier: MIT
//
// Chooses among the functions that an object file has for a kernel: the one for the newest CPU level that
// runs here, in the call's real type.
#pragma once

#include <cstdint>
#include <string_view>

#include "native/components.hpp"
#include "sk/native/code.hpp"
#include "sk/program.hpp"

namespace sk {

/// What a call requires of a kernel's object code.
struct CodeChoice {
  RealType real = RealType::Float;
  bool mayContract = false;  ///< products and sums may be fused
  bool mayReorder = false;  ///< pushes and scatters may be carried out in any order
};

/// The level with this name, such as x86-64-v3. Throws sk::Error if there is none.
native::Level levelNamed(std::string_view name);

/// The newest level that this CPU runs, but not above the one that SK_CPU names.
native::Level levelOfCpu();

/// The best entry of a kind for a CPU of this level; null if there is none. If the call allows contraction, a
/// contracted entry is better than one for a later level.
const native::Entry* findEntry(const native::Code& code, native::EntryKind kind, const CodeChoice& choice,
                               native::Level level = levelOfCpu());

/// True if an entry is for this real type, at any level.
bool hasCodeFor(const native::Code& code, RealType real);

/// The best entry of a kind for this CPU. Throws sk::Error if the code is of another version or has no entry
/// that runs here.
const native::Entry& entryOf(const program::Kernel& kernel, native::EntryKind kind, const CodeChoice& choice,
                             native::Level level = levelOfCpu());

/// An entry's function. `Function` is the type that code.hpp gives for its kind.
template <class Function>
Function* functionOf(const native::Entry& entry) {
  return reinterpret_cast<Function*>(entry.function);
}

}  // namespace sk
