// SPDX-License-Identifier: MIT
//
// Prints the descriptors of a program as the constants of FILE.sk.cpp, as the schema has them. All that a constant refers to
// comes before it, once.
#pragma once

#include <string>
#include <vector>

#include "ir/ir.hpp"
#include "program/descriptors.hpp"
#include "program/native_requests.hpp"

namespace skc::emit {

/// `names` are constantNames(): a unit's descriptors are the constants NAMEKernel and NAMEReduction.
std::string constantsText(const ir::Module& module, const Program& program,
                          const std::vector<std::string>& names, const NativeRequests& requests);

/// "constexpr TYPE NAME[] = {ITEMS};\n"; nothing if there are no items.
std::string constantList(std::string_view type, const std::string& name,
                         const std::vector<std::string>& items);

}  // namespace skc::emit
