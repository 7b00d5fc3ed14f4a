// SPDX-License-Identifier: MIT
//
// Uniforms that reach a fragment program through its vertex program, the same for every fragment:
//
//   uniform float sk_arg_k;           // vertex         flat in float sk_flat_arg_k;   // fragment
//   flat out float sk_flat_arg_k;
//
// A renderer in software copies all of its state where a uniform of the fragment program changes, and next to nothing for
// one of the vertex program. It also reads uniforms wherever they are mentioned, in loops again and again, but inputs once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sk::assemble {

struct RelayedValue {
  std::string type;
  std::string name;  ///< of the uniform
};

class RelayedValues {
 public:
  /// Whether the vertex program hands this uniform on. Each that is asked for does, as long as every device has room for it;
  /// but never samplers, structs, arrays, doubles and bools.
  bool take(std::string_view type, std::string_view name);

  const std::vector<RelayedValue>& all() const { return values_; }

 private:
  std::vector<RelayedValue> values_;
  int locations_ = 0;
};

/// What the fragment program calls a relayed uniform.
std::string relayedName(std::string_view uniform);

}  // namespace sk::assemble
