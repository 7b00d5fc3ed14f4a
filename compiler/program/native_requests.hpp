// SPDX-License-Identifier: MIT
//
// Which kernels of a program have native code, how it is compiled, and by which symbols FILE.sk.cpp refers to it.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "native/kernel_request.hpp"
#include "program/descriptors.hpp"

namespace skc::emit {

class NativeRequests {
 public:
  /// None.
  NativeRequests() = default;
  /// For all that a program may run. `names` are constantNames(). `header` is the text of FILE.sk.hpp: every symbol contains
  /// its hash ("sk_0123456789abcdef_diffuse"), so that objects of several .sk files can be linked together. Files with equal headers
  /// define the same callable objects, which the linker rejects anyway. The header contains no folder, so symbols do not depend on it.
  NativeRequests(const ir::Module& module, const Program& program, const std::vector<std::string>& names,
                 std::string_view header, bool inQuads);

  const std::vector<native::KernelRequest>& list() const { return requests_; }
  /// Empty if the kernel has no native code.
  std::string_view symbolOf(ir::KernelId kernel) const;

 private:
  friend class RequestBuilder;

  std::vector<native::KernelRequest> requests_;
  std::map<ir::KernelId, std::size_t> byKernel_;
};

}  // namespace skc::emit
