// SPDX-License-Identifier: MIT
//
// FILE.sk.js, an ES module with the programs and descriptors of a file, and FILE.sk.d.ts, the types of what it exports.
// runtime/web (the npm package `streamkernel`) runs it.
#pragma once

#include <string>
#include <string_view>

#include "ir/ir.hpp"
#include "program/descriptors.hpp"

namespace skc::web {

/// The version of what FILE.sk.js hands to the runtime, which refuses any other.
inline constexpr int moduleSchema = 3;

struct JsModule {
  std::string script;  ///< FILE.sk.js
  std::string types;  ///< FILE.sk.d.ts
};

/// The module must have passed expand-selects, as for the profile webgl2. `fileName` is the .sk file's name without
/// directories. `withShadow`: it also has the programs that device.shadow() needs.
JsModule jsModule(const ir::Module& module, const emit::Program& program, std::string_view fileName,
                  bool withShadow);

}  // namespace skc::web
