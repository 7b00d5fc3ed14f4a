// SPDX-License-Identifier: MIT
#include "info/raw_kernel.hpp"

namespace sk_tool {

RawKernel::RawKernel(std::string_view name, std::string_view body, const sk::program::Element& in,
                     const sk::program::Element& out)
    : parameters_{{{.name = "x", .symbol = "x", .role = sk::program::Role::Input, .element = &in},
                   {.name = "r", .symbol = "r", .role = sk::program::Role::Output, .element = &out}}},
      kernel_{.name = name,
              .entry = "f",
              .declarations = {},
              .body = body,
              .parameters = parameters_,
              .sources = {},
              .usesExactSums = true} {}

}  // namespace sk_tool
