// SPDX-License-Identifier: MIT
//
// A kernel with one input and one output and hand-written GLSL, for what skc does not generate: it rounds
// before it stores halves, and does not rely on `fma`. GL devices only.
#pragma once

#include <array>
#include <string_view>

#include "sk/call.hpp"

namespace sk_tool {

class RawKernel {
 public:
  /// `body` defines void f(In x, out Out r) in GLSL. It may use sk_precise and sk_keep().
  template <class In, class Out>
  static RawKernel of(std::string_view name, std::string_view body) {
    return {name, body, sk::ElementTraits<In>::element(), sk::ElementTraits<Out>::element()};
  }
  RawKernel(const RawKernel&) = delete;
  RawKernel& operator=(const RawKernel&) = delete;

  template <class In, class Out>
  void operator()(const sk::Stream<In>& x, sk::Stream<Out>& r) const {
    const std::array<sk::Argument, 2> arguments{{{.region = x.region()}, {.region = r.region()}}};
    sk::run(kernel_, arguments, {.intrinsics = sk::Intrinsics::Fast});
  }

 private:
  RawKernel(std::string_view name, std::string_view body, const sk::program::Element& in,
            const sk::program::Element& out);

  std::array<sk::program::Parameter, 2> parameters_;
  sk::program::Kernel kernel_;
};

}  // namespace sk_tool
