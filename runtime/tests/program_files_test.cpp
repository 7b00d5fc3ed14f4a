// SPDX-License-Identifier: MIT
//
// The program binary cache: another device loads the binaries, and recompiles broken ones. Also the limit on the number of
// a kernel's variants in memory.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <epoxy/gl.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "skip.hpp"
#include "test_kernel.hpp"

namespace {

using namespace sk;
using namespace sk::test;
namespace fs = std::filesystem;

class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { old_ ? ::setenv(name_, old_->c_str(), 1) : ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

std::string contentsOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// FNV-1a, like the runtime's checksum.
std::uint64_t hashOf(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

/// A cache folder and a trace for this test alone.
class Folder {
 public:
  Folder() { fs::create_directories(path_); }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  /// The files of the kernel's programs. Others are left out: measuring for the trace compiles programs, too.
  std::vector<fs::path> programs() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(path_)) {
      const bool isProgram = entry.path().filename().string().starts_with("program-");
      const std::string text = contentsOf(entry.path());
      if (isProgram && text.substr(0, text.find('\n')).find("twice") != std::string::npos)
        found.push_back(entry.path());
    }
    return found;
  }
  /// Changes the binary in each program's file, and updates its checksum if `isRight`.
  void change(bool isRight, const std::function<void(std::string&)>& edit) const {
    for (const fs::path& file : programs()) {
      const std::string text = contentsOf(file);
      const std::size_t line = text.find('\n') + 1;
      const std::size_t body = text.find('\n', line) + 1;
      std::string binary = text.substr(body);
      edit(binary);
      std::ofstream out(file, std::ios::binary);
      out << text.substr(0, line);
      if (isRight) {
        out << std::hex << std::setfill('0') << std::setw(16) << hashOf(binary) << ' ' << std::dec
            << binary.size() << '\n';
      } else {
        out << text.substr(line, body - line);
      }
      out << binary;
    }
  }
  /// Doubles numbers on a new device. Returns the number of cache hits in its trace.
  std::size_t hits(const std::string& profile) const {
    static const TestKernel twice("twice", "void twice(float x, out float r) { r = 2.0 * x; }\n",
                                  {input<float>("x"), output<float>("r")});
    const Variable cache("SK_CACHE", path_);
    const fs::path trace = path_ / "trace.json";
    const Variable traced("SK_TRACE", trace);
    fs::remove(trace);
    {
      Device device(DeviceOptions{.profile = profile});
      auto x = device.stream<float>({3, 5});
      x.write(std::vector<float>(15, 1.5F));
      twice(x, x);
      CHECK(x.read() == std::vector<float>(15, 3));
      hasBinaries = hasBinaries && formats() > 0;
    }
    const std::string text = contentsOf(trace);
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find("\"cache\":\"hit\"", at)) != std::string::npos; ++at) ++found;
    return found;
  }

  mutable bool hasBinaries = true;  ///< whether every device so far supports program binaries

 private:
  static GLint formats() {
    GLint count = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
    return count;
  }

  fs::path path_ = fs::temp_directory_path() / ("sk_programs_" + std::to_string(::getpid()));
};

constexpr std::size_t formatBytes = 4;

}  // namespace

TEST_CASE("a program that one device has compiled is another's without compiling") {
  for (const std::string& profile : profileNames) {
    const Folder folder;
    CHECK(folder.hits(profile) == 0);
    if (!folder.hasBinaries) {
      skip("the driver gives no binaries of programs of " + profile);
      continue;
    }
    CHECK(folder.programs().size() == 1);
    CHECK(folder.hits(profile) == 1);
    CHECK(folder.programs().size() == 1);
  }
}

TEST_CASE("a broken binary, and one that the driver refuses, is made anew") {
  const Folder folder;
  folder.hits("");
  if (!folder.hasBinaries) {
    skip("the driver gives no binaries of programs");
    return;
  }
  const auto breaks = [&](bool isRight, const std::function<void(std::string&)>& edit) {
    folder.change(isRight, edit);
    CHECK(folder.hits("") == 0);
    CHECK(folder.hits("") == 1);
  };
  breaks(false, [](std::string& text) { text.back() = static_cast<char>(~text.back()); });
  breaks(false, [](std::string& text) { text.resize(text.size() / 2); });
  breaks(false, [](std::string& text) { text.clear(); });
  breaks(true, [](std::string& text) { text.clear(); });
  breaks(true, [](std::string& text) { text.resize(formatBytes); });
  breaks(true, [](std::string& text) { text[0] = static_cast<char>(~text[0]); });  // another format
  breaks(true, [](std::string& text) {  // whole, but no program
    text = text.substr(0, formatBytes) + std::string(text.size() - formatBytes, 'x');
  });
}

TEST_CASE("of a kernel's variants, those that were not used for longest are deleted") {
  static const TestKernel special(
      "special", "void special(int n, float x, out float r) { r = x + float(n); }\n",
      {parameter<int>("n", program::Role::Spec), input<float>("x"), output<float>("r")});
  Device device;
  auto x = device.stream<float>({4}), r = device.stream<float>({4});
  x.write(std::vector<float>{1, 2, 3, 4});
  device.makeCurrent();
  const auto programs = [] {
    int count = 0;
    for (GLuint name = 1; name < 5000; ++name) count += glIsProgram(name) == GL_TRUE ? 1 : 0;
    return count;
  };
  for (int n = 0; n < 270; ++n) {
    special(n, x, r);
    special(0, x, r);  // never the least recently used
  }
  CHECK(r.read() == std::vector<float>{1, 2, 3, 4});
  CHECK(programs() >= 256);
  CHECK(programs() <= 260);
  for (int n = 265; n < 275; ++n) special(n, x, r);
  CHECK(r.read() == std::vector<float>{275, 276, 277, 278});
  CHECK(programs() <= 260);
}
