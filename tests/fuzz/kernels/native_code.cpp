// SPDX-License-Identifier: MIT
#include "kernels/native_code.hpp"

#include <cstdlib>
#include <fstream>
#include <map>
#include <stdexcept>

#include <dlfcn.h>

#include "driver/native_library.hpp"
#include "native/native.hpp"
#include "program/stub.hpp"
#include "sk/native/code.hpp"
#include "temporary_folder.hpp"

namespace fuzz {
namespace {

using sk::native::Level;
using sk::native::levelOfHardware;
using skc::native::KernelRequest;

/// Links an object file and loads it for as long as the process lives. Returns the addresses of the codes, whose symbols
/// are hidden, as an application's are.
const sk::native::Code* const* load(const std::string& object, const std::vector<KernelRequest>& requests) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "random.o").string(),
                    table = (folder.path() / "codes.c").string(),
                    library = (folder.path() / "random.so").string();
  std::ofstream(file, std::ios::binary) << object;
  std::string declared, listed;
  for (const KernelRequest& request : requests) {
    declared += "extern const char " + request.symbol + "[];\n";
    listed += "  " + request.symbol + ",\n";
  }
  std::ofstream(table) << declared << "const char *const codes[] = {\n" << listed << "};\n";
  const std::string command =
      SK_LINKER " -shared -fPIC -o '" + library + "' -x c '" + table + "' -x none '" + file + "' -lm";
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error("the object file cannot be linked: " + command);
  void* const loaded = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (loaded == nullptr)
    throw std::runtime_error(std::string("the native code cannot be loaded: ") + dlerror());
  return static_cast<const sk::native::Code* const*>(dlsym(loaded, "codes"));
}

}  // namespace

skc::emit::Program withNativeCode(const skc::ir::Module& module, const std::string& level) {
  const std::vector<KernelRequest> requests =
      skc::emit::emitStub(module, skc::emit::Program(module), "random.sk", {}).native;
  skc::native::Options options;
  if (!level.empty()) options.levels = {level};
  const sk::native::Code* const* const codes =
      load(skc::native::compile(module, requests, skc::driver::compileLibrary, options,
                                skc::native::Output::Object),
           requests);
  std::map<skc::ir::KernelId, std::size_t> best;  // a reduce may also be requested as one that only combines
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const auto [found, isNew] = best.try_emplace(requests[i].kernel, i);
    if (!isNew && requests[found->second].onlyCombines) found->second = i;
  }
  return skc::emit::Program(module, {}, [&](skc::ir::KernelId id) -> const sk::native::Code* {
    const auto found = best.find(id);
    return found == best.end() ? nullptr : codes[found->second];
  });
}

std::vector<std::string> supportedLevels() {
  std::vector<std::string> levels;
#if defined(__x86_64__) && defined(__GNUC__)
  levels.emplace_back("x86-64");
  if (levelOfHardware() >= Level::V3) levels.emplace_back("x86-64-v3");
  if (levelOfHardware() >= Level::V4) levels.emplace_back("x86-64-v4");
#else
  levels.emplace_back();
#endif
  return levels;
}

}  // namespace fuzz
