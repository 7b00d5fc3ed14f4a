// SPDX-License-Identifier: MIT
//
// The native back end compiles the kernels of a module to vector code, one element per lane, and writes an
// object file with one constant sk::native::Code per kernel (sk/native/code.hpp). Only this folder uses LLVM,
// and it must not use Clang. It takes the IR as runTransforms leaves it.
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

/// The form in which compile() returns the code.
enum class Output : std::uint8_t { Object, Assembly, Llvm };

struct Options {
  std::string triple = {};  ///< empty: the host
  std::vector<std::string> levels = {};  ///< CPU levels, as levelNames() has them, or "native"; empty: all
  std::uint32_t lanes = 0;  ///< elements computed together; 0: chosen per kernel
  bool debugInfo = false;  ///< describes lines and variables of the .sk file
  bool optimizes = true;  ///< false: variables stay in memory, where debuggers find them
};

/// An invalid option: an unknown triple or level, or an impossible number of lanes. The message is
/// lower-case, without a period.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws the Error that compile() would throw for these options.
void checkOptions(const Options& options);

/// The names of the target's CPU levels, lowest first; empty if it has none.
std::vector<std::string_view> levelNames(const std::string& triple);

/// Returns the object file, the assembly or the LLVM IR of these kernels. Objects are position-independent.
/// Throws Error if an option is invalid.
std::string compile(const ir::Module& module, const std::vector<KernelRequest>& kernels,
                    const CompileLibrary& compileLibrary, const Options& options, Output output);

/// From now on, calls the function where LLVM or Clang finds no more memory; it must not return.
void setNoMemoryHandler(void (*handler)());

}  // namespace skc::native
