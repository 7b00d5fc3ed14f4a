// SPDX-License-Identifier: MIT
//
// Generates a whole program: enumerations, structs with methods, constants, functions, and kernels that call them. It is
// valid .sk and C++ (sk_as_cpp.hpp) at once.
#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "cpp/tree.hpp"

namespace fuzz::cpp {

struct Program {
  NodePtr root;  ///< a List of declarations
  int functions = 0;  ///< that kernels call, with methods, and the kernels
};

/// Program `number` of a seed is always the same. `without` names the constructs that are left out (unit.hpp).
Program generate(std::uint64_t seed, std::uint64_t number, const std::set<std::string>& without);

}  // namespace fuzz::cpp
