// SPDX-License-Identifier: MIT
//
// Uniforms that the vertex program passes to the fragment program as flat inputs:
//
//   uniform float sk_arg_k;           // vertex         flat in float sk_flat_arg_k;   // fragment
//   flat out float sk_flat_arg_k;
//
// A software renderer copies all of its state when a uniform of the fragment program changes, but almost none
// for a uniform of the vertex program. It also reads uniforms at every use, even in loops, but inputs only
// once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sk::assemble {

struct RelayedValue {
  std::string type;
  std::string name;  ///< the uniform's
};

class RelayedValues {
 public:
  /// Relays a uniform and returns true, if every device has room for it. Never relays samplers, structs,
  /// arrays, doubles and bools.
  bool take(std::string_view type, std::string_view name);

  const std::vector<RelayedValue>& all() const { return values_; }

 private:
  std::vector<RelayedValue> values_;
  int locations_ = 0;
};

/// The name of a relayed uniform in the fragment program.
std::string relayedName(std::string_view uniform);

}  // namespace sk::assemble
