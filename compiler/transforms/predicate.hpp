// SPDX-License-Identifier: MIT
//
// predicate: makes control flow uniform for several elements that are computed together, one per lane. What a
// single element does depends on masks, bool variables that are true in the active lanes. Only native code
// needs this, on a copy of the module.
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
//   * Uniform control flow stays as it is. `if (AnyLane(mask))` guards a branch that takes long.
//   * An assignment preserves the value of inactive lanes only if they can read it (Uniformity::blends): the
//     counter of a loop that lanes leave early stays uniform.
//   * A function whose loops or pushes depend on its caller's mask takes the mask as a last bool parameter.
//     So does an entry with such a loop or pushes, because a group of lanes may extend past the domain.
//   * `&&`, `||` and `?:` may evaluate all operands: calls that may take long are moved out of them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ir/ir.hpp"

namespace skc {

/// Its name for --print-after.
inline constexpr std::string_view predicateName = "predicate";

/// Takes the output of runTransforms. Debug builds validate the result.
void predicate(ir::Module& module);

/// The entry's mask, which is true in the lanes that have an element; nullopt if the kernel needs none.
std::optional<ir::VarId> entryMask(const ir::Module& module, const ir::Kernel& kernel);

/// Checks the postcondition of predicate: the module is valid, and no control flow depends on a varying value. Returns the
/// first violation, or an empty string.
std::string validatePredicated(const ir::Module& module);

}  // namespace skc
