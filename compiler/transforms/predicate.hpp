// SPDX-License-Identifier: MIT
//
// predicate: makes control flow the same for several elements that are computed together, each in a lane. What an element
// does alone depends on masks, bool variables that are true in the lanes which take part. Only native code wants this, on
// a copy of the module.
//
//   float r = 0;                                  float r = 0;
//   if (x > 0) r = x;                             bool mask = x > 0;
//                                                 r = mask ? x : r;
//   for (int i = 0; i < n; ++i) {                 for (int i = 0, bool live = true; i < n && AnyLane(live); ++i) {
//     if (r > x) break;                             bool mask = live && r > x;
//                                                   live = live && !mask;
//     r += f(r);                                    r = live ? r + f(r) : r;
//   }                                             }
//
//   * Uniform control flow stays as it is. `if (AnyLane(mask))` stands around a branch that takes long.
//   * An assignment keeps the value of inactive lanes only where they can read it (Uniformity::blends): the counter
//     of a loop that lanes leave early stays uniform.
//   * A function whose loops or pushes depend on who calls it takes its first mask as a bool behind its parameters. So does
//     an entry with such a loop or pushes, because a group of lanes may reach beyond the domain.
//   * `&&`, `||` and `?:` may be evaluated in full: a call that may take long for some values is not left behind one.
#pragma once

#include <optional>
#include <string_view>

#include "ir/ir.hpp"

namespace skc {

/// What --print-after calls it.
inline constexpr std::string_view predicateName = "predicate";

/// Takes the module that runTransforms leaves. Debug builds validate the result.
void predicate(ir::Module& module);

/// The variable of a predicated kernel's entry that is true in the lanes that have an element; none where it needs none.
std::optional<ir::VarId> entryMask(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc
