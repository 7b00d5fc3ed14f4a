// SPDX-License-Identifier: MIT
//
// The symbols by which the descriptors of FILE.sk.cpp refer to the code in FILE.sk.o.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "native/kernel_request.hpp"

namespace skc::emit {

/// The symbols of one file, and the requests for the code behind them.
class NativeSymbols {
 public:
  /// `header` is the text of FILE.sk.hpp. Every symbol contains its hash, so that objects of several .sk
  /// files can be linked together. Files with equal headers define the same callable objects, which the
  /// linker rejects anyway. The header contains no folder, so symbols do not depend on it.
  explicit NativeSymbols(std::string_view header);

  /// Requests code and returns its symbol: "sk_0123456789abcdef_diffuse" for `descriptor` "diffuse". Sets the
  /// symbol of the request.
  std::string add(const std::string& descriptor, native::KernelRequest request);

  /// All requests, in the order in which they were added.
  const std::vector<native::KernelRequest>& requests() const { return requests_; }

 private:
  std::string prefix_;
  std::vector<native::KernelRequest> requests_;
};

}  // namespace skc::emit
