// SPDX-License-Identifier: MIT
//
// The native back end: kernels of a module as LLVM vectors, several elements to a vector, and as an object file that has a
// constant sk::native::Code for each of them (sk/native/code.hpp). Only this folder knows LLVM; it must not know Clang, and
// takes the IR as runTransforms leaves it.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "native/kernel_request.hpp"
#include "native/library/link_library.hpp"

namespace skc::native {

/// What is written for a module.
enum class Output : std::uint8_t { Object, Assembly, Llvm };

struct Options {
  std::string triple = {};  ///< empty: of the machine that skc runs on
  std::vector<std::string> levels = {};  ///< of the CPU, as levelNames() has them; empty: all
  std::uint32_t lanes = 0;  ///< elements computed together; 0: chosen for each kernel
  bool debugInfo = false;  ///< lines and variables of the .sk file for debuggers
  bool optimizes = true;  ///< else every variable stays in memory, where debuggers find it
};

/// A mistake in the options, lower-case and without a period: an unknown triple, level or number of lanes.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws Error where compile() would because of the options.
void checkOptions(const Options& options);

/// Names of the levels of the target's CPU, lowest first; of a CPU without levels, none.
std::vector<std::string_view> levelNames(const std::string& triple);

/// The object file (its bytes), the assembly or the LLVM IR of these kernels. The object is position independent.
std::string compile(const ir::Module& module, const std::vector<KernelRequest>& kernels,
                    const CompileLibrary& compileLibrary, const Options& options, Output output);

}  // namespace skc::native
