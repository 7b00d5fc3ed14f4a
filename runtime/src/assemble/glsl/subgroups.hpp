// SPDX-License-Identifier: MIT
//
// Subgroups of compute programs (GL_KHR_shader_subgroup): the invocations of a work group that a device runs together.
#pragma once

#include <string>

namespace sk::assemble {

/// The #extension lines of a program that uses subgroups; each ends its line.
inline std::string subgroupExtensions() {
  return "#extension GL_KHR_shader_subgroup_basic : require\n"
         "#extension GL_KHR_shader_subgroup_ballot : require\n"
         "#extension GL_KHR_shader_subgroup_arithmetic : require\n"
         "#extension GL_KHR_shader_subgroup_shuffle : require\n"
         "#extension GL_KHR_shader_subgroup_shuffle_relative : require\n";
}

}  // namespace sk::assemble
