// SPDX-License-Identifier: MIT
//
// The table of profiles: one row per version of a target.
#include <algorithm>
#include <array>

#include "assemble/assemble.hpp"

namespace sk::assemble {
namespace {

constexpr std::array table = {
    // name      #version  stage  es  draw buffers or images  texture units  uniform components (guaranteed minima)
    Profile{"glsl330", "#version 330 core", Stage::Fragment, false, 8, 16, 1024, Doubles::Native},
    Profile{"essl300", "#version 300 es", Stage::Fragment, true, 4, 16, 896, Doubles::Pairs},
    Profile{"glsl430", "#version 430 core", Stage::Compute, false, 8, 16, 1024, Doubles::Native},
    Profile{"webgl2", "#version 300 es", Stage::Fragment, true, 4, 16, 896, Doubles::Pairs, true},
};

}  // namespace

std::span<const Profile> profiles() { return table; }

const Profile* findProfile(std::string_view name) {
  const auto row = std::ranges::find(table, name, &Profile::name);
  return row == table.end() ? nullptr : &*row;
}

}  // namespace sk::assemble
