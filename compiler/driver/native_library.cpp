// SPDX-License-Identifier: MIT
#include "driver/native_library.hpp"

#include <optional>
#include <sstream>
#include <string>

#include "frontend/frontend.hpp"
#include "support/internal_error.hpp"

namespace skc::driver {

/// An error in the library is a bug of skc: the tests compile all of it.
ir::Module compileLibrary(std::string_view file, std::string_view text) {
  std::ostringstream messages;
  frontend::Options options;
  options.messages = &messages;
  options.isLibrary = true;
  frontend::Frontend frontend(options);
  std::optional<ir::Module> module = frontend.compile(std::string(file), std::string(text));
  if (module) return std::move(*module);
  internalError("the library of native code does not compile: " + messages.str());
}

native::LinkedFunctions linkNativeLibrary(ir::Module& module) {
  return native::linkLibrary(module, compileLibrary);
}

}  // namespace skc::driver
