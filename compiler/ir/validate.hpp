// SPDX-License-Identifier: MIT
//
// The meaning of the IR (ir.hpp) made executable. A violation is a bug of skc, never of the user.
#pragma once

#include <cstdint>
#include <string>

#include "ir/ir.hpp"

namespace skc::ir {

enum class Stage : std::uint8_t {
  Lowered,      ///< as the frontend produces it
  Specialized,  ///< from specialize-gathers on: streams are parameters of kernels
  Predicated,  ///< after predicate: with masks. validatePredicated checks that control flow is uniform
};

/// Returns the first violation with its path: "kernel diffuse: function 2 'diffuse': line 7: operands of '+'
/// are float and int". Empty if the module is valid.
std::string validate(const Module& module, Stage stage);

}  // namespace skc::ir
