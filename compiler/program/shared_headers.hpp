// SPDX-License-Identifier: MIT
//
// Structs of headers that C++ and .sk files share: FILE.sk.hpp includes the header instead of declaring them.
#pragma once

#include <string>
#include <vector>

#include "ir/ir.hpp"

namespace skc::emit {

/// True if C++ has the struct from a header that the .sk file includes.
bool isShared(const ir::Module& module, const ir::Struct& type);

/// The paths by which FILE.sk.hpp includes the shared headers of the structs that it uses: relative to the first of `folders` that
/// contains the header, else to the .sk file's folder.
std::vector<std::string> sharedHeaders(const ir::Module& module, const std::vector<std::string>& folders);

/// The text that checks, in FILE.sk.cpp, that shared structs are the same for C++ as for kernels; empty if there are none.
std::string layoutChecks(const ir::Module& module);

}  // namespace skc::emit
