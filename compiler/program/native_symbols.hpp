// SPDX-License-Identifier: MIT
//
// The symbols by which the descriptors of FILE.sk.cpp and the code in FILE.sk.o find each other. Nothing else names one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "native/kernel_request.hpp"

namespace skc::emit {

/// The symbols of one file, and the requests for the code behind them.
class NativeSymbols {
 public:
  /// `header` is the text of FILE.sk.hpp. Its hash is in every symbol, so that objects of several .sk files can be linked
  /// together: files whose headers are equal define the same callable objects, which the linker does not accept anyway. The
  /// header names no folder, so that symbols do not depend on where a file is compiled.
  explicit NativeSymbols(std::string_view header);

  /// Requests code, and returns its symbol: "sk_0123456789abcdef_diffuse" for `descriptor` "diffuse". The symbol of the
  /// request is filled in here.
  std::string add(const std::string& descriptor, native::KernelRequest request);

  /// All requests, in the order in which they were added.
  const std::vector<native::KernelRequest>& requests() const { return requests_; }

 private:
  std::string prefix_;
  std::vector<native::KernelRequest> requests_;
};

}  // namespace skc::emit
