// SPDX-License-Identifier: MIT
//
// Values that reach the fragment program of a kernel through its vertex program, the same for every fragment:
//
//   uniform float sk_arg_k;           // vertex         flat in float sk_flat_arg_k;   // fragment
//   flat out float sk_flat_arg_k;
//
// A renderer in software copies all of its state where a uniform of the fragment program changes, and next to nothing for
// one of the vertex program. So what calls change often goes this way: arguments, iterators, and where views begin.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "assemble/assemble.hpp"

namespace sk::assemble {

struct RelayedValue {
  std::string_view type;
  std::string name;  ///< of the uniform
};

/// Those of a kernel's program, as many as every device has room for. None where the profile relays none. Structs, arrays,
/// doubles and bools are never among them.
std::vector<RelayedValue> relayedValues(const Profile& profile, const program::Kernel& kernel,
                                        const Variant& variant);

/// What the fragment program calls a relayed value.
std::string relayedName(std::string_view uniform);

}  // namespace sk::assemble
