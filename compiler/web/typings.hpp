// SPDX-License-Identifier: MIT
//
// Types of TypeScript for what a .sk file declares.
#pragma once

#include <string>
#include <string_view>

#include "ir/ir.hpp"
#include "program/descriptors.hpp"
#include "web/js_names.hpp"

namespace skc::web {

/// FILE.sk.d.ts.
std::string typings(const ir::Module& module, const emit::Program& program, const JsNames& names,
                    std::string_view fileName);

}  // namespace skc::web
