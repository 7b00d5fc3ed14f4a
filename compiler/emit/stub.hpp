// SPDX-License-Identifier: MIT
//
// The C++ that an application compiles: FILE.sk.hpp with a callable object for each kernel, and
// FILE.sk.cpp with its descriptors. It must read as if a person had written it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "emit/native_code.hpp"
#include "emit/program.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

struct Stub {
  std::string header;   ///< FILE.sk.hpp
  std::string source;   ///< FILE.sk.cpp
};

/// `fileName` is the .sk file's name without directories: the source includes "heat.sk.hpp" for "heat.sk".
/// `native`: the real types of the source's native code; none if it has no such code.
Stub emitStub(const ir::Module& module, const Program& program, std::string_view fileName,
              std::optional<Reals> native);

}  // namespace skc::emit
