// SPDX-License-Identifier: MIT
//
// The C++ that an application compiles: FILE.sk.hpp with a callable object per kernel, and FILE.sk.cpp with
// its descriptors. It must read as if a person had written it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "native/kernel_request.hpp"
#include "program/descriptors.hpp"

namespace skc::emit {

struct Stub {
  std::string header;   ///< FILE.sk.hpp
  std::string source;   ///< FILE.sk.cpp
  std::vector<native::KernelRequest> native;   ///< the code that the source refers to, for FILE.sk.o
};

struct StubOptions {
  bool native = true;  ///< the descriptors refer to native code
  bool quad = false;  ///< the native code also computes in __float128
  std::vector<std::string> includeDirectories =
      {};  ///< where C++ finds headers that it shares with .sk files
  bool withLibrary = false;  ///< the source lists its descriptors: sk/library.hpp
};

/// `fileName` is the .sk file's name without directories: the source includes "heat.sk.hpp" for "heat.sk".
Stub emitStub(const ir::Module& module, const Program& program, std::string_view fileName,
              const StubOptions& options);

}  // namespace skc::emit
