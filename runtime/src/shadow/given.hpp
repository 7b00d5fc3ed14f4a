// SPDX-License-Identifier: MIT
//
// What the host gives to kernels: the values of parameters, and the streams that it has written. The options `given=list` and `set=` of
// SK_SHADOW list them in the report and replace them, for `sk stress`.
#pragma once

#include <cstddef>
#include <vector>

#include "shadow/shadow_call.hpp"

namespace sk {

/// Lists what a call is given, and replaces what the options name: values for this call, elements of streams for good. The call
/// with the values lives as long as this object.
class GivenArguments {
 public:
  GivenArguments(ShadowDevice& device, const ShadowedCall& call);
  GivenArguments(const GivenArguments&) = delete;
  GivenArguments& operator=(const GivenArguments&) = delete;

  const ShadowedCall& call() const { return call_; }

 private:
  void examineValue(std::size_t argument);
  void examineStream(std::size_t argument, ShadowStream& stream);

  ShadowDevice& device_;
  std::vector<Argument> arguments_;
  std::vector<std::vector<std::byte>> values_;  ///< of arguments that are replaced
  ShadowedCall call_;
};

}  // namespace sk
