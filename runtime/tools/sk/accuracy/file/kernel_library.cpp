// SPDX-License-Identifier: MIT
#include "accuracy/file/kernel_library.hpp"

#include <dlfcn.h>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "accuracy/child_process.hpp"
#include "support/cache_folder.hpp"

namespace sk_tool {

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

fs::path ownFolder() { return fs::read_symlink("/proc/self/exe").parent_path(); }

/// The files that skc generates.
struct Compiled {
  fs::path header, source, object;
  /// Defines the functions of __float128 by MPFR; empty: libquadmath's are linked.
  fs::path precise = {};

  Compiled(const fs::path& folder, const fs::path& file) {
    const std::string base = (folder / file.filename()).string();
    header = base + ".hpp";
    source = base + ".cpp";
    object = base + ".o";
  }
};

/// Compiles a file to FOLDER/NAME.sk.hpp, .cpp and .o.
void runSkc(const fs::path& file, const BuildOptions& options, const fs::path& folder) {
  Words words = skcWords(options);
  const std::string skc = words.front();
  for (const std::string& word :
       {std::string("--library"), std::string("--quad"), std::string("-o"), folder.string(), file.string()})
    words.push_back(word);
  const std::optional<int> status = runProgram(words);
  if (!status) {
    throw std::runtime_error(fmt::format("there is no '{}' to compile '{}'; name one by --skc FILE or SK_SKC",
                                         skc, file.string()));
  }
  if (*status != 0) throw std::runtime_error(fmt::format("skc does not take '{}'", file.string()));
}

/// The folder that contains sk/sk.hpp: SK_INCLUDE, else the installation's or the build folder's.
fs::path headerFolder() {
  std::vector<fs::path> folders{ownFolder() / SK_INCLUDE_FROM_BIN, ownFolder().parent_path() / "include"};
  if (const std::string chosen = variable("SK_INCLUDE"); !chosen.empty()) folders = {chosen};
  for (const fs::path& folder : folders) {
    if (fs::exists(folder / "sk" / "library.hpp")) return folder.lexically_normal();
  }
  throw std::runtime_error(fmt::format(
      "there are no headers of StreamKernel in '{}'; set SK_INCLUDE to the folder that has sk/sk.hpp",
      folders.front().lexically_normal().string()));
}

/// Links stubs and object to a library, using the compiler named by CXX, which may be several words, else the
/// first one found. The stubs are constants and a few calls and need no optimization.
void runCompiler(const Compiled& compiled, const fs::path& library) {
  std::vector<Words> compilers{{"c++"}, {"g++"}};
  if (std::istringstream chosen(variable("CXX")); !chosen.str().empty()) {
    compilers.assign(1, {});
    for (std::string word; chosen >> word;) compilers.front().push_back(word);
  }
  Words options{
      "-std=c++20", "-O0", "-w", "-fPIC", "-shared",
      // keeps only descriptors and what they refer to: the stubs call the runtime, which is not linked here
      "-fvisibility=hidden", "-ffunction-sections", "-Wl,--gc-sections", "-I" + headerFolder().string(),
      compiled.source.string(), compiled.object.string(), "-o", library.string()};
  if (!compiled.precise.empty()) {
    for (const char* word : {compiled.precise.c_str(), "-lmpfr"}) options.emplace_back(word);
  } else {
#if defined(__x86_64__) || defined(__i386__) || defined(__powerpc64__)
    options.emplace_back("-lquadmath");  // __float128 is not long double there
#endif
  }
  for (Words words : compilers) {
    words.insert(words.end(), options.begin(), options.end());
    const std::optional<int> status =
        runProgram(words, compiled.precise.empty() ? Messages::Shown : Messages::Hidden);
    if (!status) continue;
    if (*status == 0) return;
    throw std::runtime_error(fmt::format(
        "'{}' cannot compile what skc made of the file; CXX names another compiler", words.front()));
  }
  throw std::runtime_error(
      "there is no C++ compiler, which the descriptors of kernels need; install one (Debian: g++), or name "
      "it "
      "by CXX");
}

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What the library depends on: the compiler, the headers and skc's output.
std::string keyOf(const Compiled& compiled) {
  const fs::path headers = headerFolder();
  fs::file_time_type newest = fs::file_time_type::min();
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(headers / "sk")) {
    newest = std::max(newest, entry.last_write_time());
  }
  return fmt::format("StreamKernel {}, CXX '{}', {}headers in {} of {}: {}{}{}", SK_VERSION, variable("CXX"),
                     compiled.precise.empty() ? "" : "MPFR, ", headers.string(),
                     newest.time_since_epoch().count(), textOf(compiled.header), textOf(compiled.source),
                     textOf(compiled.object));
}

/// Caches the library, because a compilation takes a second or more.
void linkKept(const Compiled& compiled, const fs::path& library) {
  const std::string key = keyOf(compiled);
  const sk::CacheFolder cache;
  if (const std::optional<std::string> kept = cache.read("kernels", key)) {
    std::ofstream(library, std::ios::binary) << *kept;
    return;
  }
  runCompiler(compiled, library);
  cache.write("kernels", key, textOf(library));
}

}  // namespace

std::vector<std::string> skcWords(const BuildOptions& options) {
  std::string skc = options.skc.empty() ? variable("SK_SKC") : options.skc;
  if (skc.empty()) skc = fs::exists(ownFolder() / "skc") ? (ownFolder() / "skc").string() : "skc";
  Words words{skc};
  for (const std::string& include : options.includes) words.push_back("-I" + include);
  for (const std::string& definition : options.definitions) words.push_back("-D" + definition);
  return words;
}

namespace {

const sk::program::Library* listIn(void* object) {
  return static_cast<const sk::program::Library*>(::dlsym(object, sk::program::librarySymbol));
}

}  // namespace

KernelLibrary::KernelLibrary(const fs::path& file, const BuildOptions& options) {
  const TemporaryFolder folder;
  runSkc(file, options, folder.path());
  Compiled compiled(folder.path(), file);
  const fs::path library = folder.path() / "kernels.so";
  linkKept(compiled, library);
  object_ = ::dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (object_ == nullptr) {
    throw std::runtime_error(
        fmt::format("cannot load the kernels: {}; is '{}' a place for programs? TMPDIR names another",
                    ::dlerror(), folder.path().parent_path().string()));
  }
  list_ = listIn(object_);
  if (list_ == nullptr) {
    ::dlclose(object_);
    throw std::runtime_error(
        "this skc is of another version; name the one that belongs to this program by --skc");
  }
#if defined(__x86_64__)
  compiled.precise = folder.path() / "precise.cpp";
  std::ofstream(compiled.precise) << "#include <sk/native/quads_by_mpfr.hpp>\n";
  const fs::path precise = folder.path() / "precise.so";
  try {
    linkKept(compiled, precise);
  } catch (const std::runtime_error&) {
    return;  // there is no MPFR
  }
  preciseObject_ = ::dlopen(precise.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (preciseObject_ != nullptr) preciseList_ = listIn(preciseObject_);
#endif
}

KernelLibrary::~KernelLibrary() {
  if (preciseObject_ != nullptr) ::dlclose(preciseObject_);
  ::dlclose(object_);
}

}  // namespace sk_tool
