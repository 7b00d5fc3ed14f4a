// SPDX-License-Identifier: MIT
//
// The numbers of elements in host memory, member by member. Must not know streams.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "results/results_file.hpp"
#include "sk/program.hpp"

namespace sk::results {

/// A member of an element: all planes of one path.
struct Member {
  std::string_view path;  ///< empty if the element is no struct
  std::span<const program::Field> fields;
  std::size_t firstComponent = 0;  ///< among the components of the element
};

std::vector<Member> membersOf(const program::Element& element);

/// The numbers of a member: `elements` are laid out as the element says.
Values valuesOf(const Member& member, const program::Element& element, const std::byte* elements,
                std::size_t count);
/// Likewise from the components of whole elements, all of them floats.
Values valuesOf(const Member& member, const program::Element& element, std::span<const double> components,
                Values::Kind kind);

}  // namespace sk::results
