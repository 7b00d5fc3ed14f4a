// SPDX-License-Identifier: MIT
//
// Loads two libraries in turn, the second one where the first was, and runs the kernels of both on one device: programs, tables
// and loops of the first one are not those of the second. The arguments are the libraries.
#include <array>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

#include <dlfcn.h>

#include <sk/sk.hpp>

namespace {

using Apply = void (*)(sk::Device&, std::array<float, 4>&, sk::Loop*);

class Library {
 public:
  explicit Library(const char* file) : file_(file), handle_(::dlopen(file, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw std::runtime_error(::dlerror());
    apply = reinterpret_cast<Apply>(::dlsym(handle_, "apply"));
  }
  ~Library() {
    ::dlclose(handle_);
    if (::dlopen(file_, RTLD_LAZY | RTLD_NOLOAD) != nullptr)
      std::fprintf(stderr, "%s is still loaded\n", file_);
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  Apply apply;

 private:
  const char* const file_;
  void* const handle_;
};

void expect(bool isTrue, const std::string& what) {
  if (!isTrue) throw std::runtime_error(what);
}

void expectResults(const std::array<float, 4>& results, float factor) {
  constexpr std::array<const char*, 4> names = {"scale", "total", "spread", "curve"};
  for (std::size_t i = 0; i < results.size(); ++i) {
    expect(results[i] == factor,
           names[i] + (" gives " + std::to_string(results[i])) + ", not " + std::to_string(factor));
  }
}

/// Returns how often a library was loaded where another one had been before.
int run(const sk::DeviceOptions& options, const char* const libraries[2]) {
  sk::Device device(options);
  sk::Loop loop;
  std::array<float, 4> results{};
  const void* place = nullptr;
  int sharedPlaces = 0;
  for (int i = 0; i < 4; ++i) {
    const Library library(libraries[i % 2]);
    const auto* const found = reinterpret_cast<const void*>(library.apply);
    sharedPlaces += std::exchange(place, found) == found ? 1 : 0;
    library.apply(device, results, i == 0 ? &loop : nullptr);
    expectResults(results, i % 2 == 0 ? 3.0F : 7.0F);
    if (i == 0) loop.repeat(1);
  }
  std::string message;
  try {
    loop.repeat(1);
  } catch (const sk::Error& error) {
    message = error.what();
    expect(error.kind() == sk::Error::Kind::Lost, "the loop's error is of another kind");
  }
  expect(message.starts_with("a loop: a library with kernels that it runs has been unloaded"),
         "the loop of an unloaded library says '" + message + "'");
  return sharedPlaces;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    expect(count == 3, "give two libraries");
    run({.device = "native"}, arguments + 1);
    const int shared = run({.device = "software", .profile = "glsl330"}, arguments + 1) +
                       run({.device = "software", .profile = "glsl430"}, arguments + 1);
    expect(shared > 0, "the loader has never used the place of an unloaded library again");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
