// SPDX-License-Identifier: MIT
//
// Runs other programs and waits for them: any one, and gnuplot for every command that draws a chart. A temporary folder
// holds their files; its destructor deletes it with its contents.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace sk_tool {

enum class Messages : std::uint8_t { Shown, Hidden };

/// Runs words[0], searched for in PATH unless it contains a slash, with the other words as its arguments and
/// with this process's standard streams, or without those for output; its standard output goes to the file `output` if that has a name. Returns its exit status, 128 plus the number of the signal that
/// ended it, or nullopt if there is no such program.
std::optional<int> runProgram(std::vector<std::string> words, Messages messages = Messages::Shown,
                              const std::string& output = "");

/// Throws std::runtime_error unless a file of this name can be written, so that long work does not end in vain. Makes no file.
void checkWritable(const std::string& file);

/// Likewise for a chart: throws unless its name ends in .svg or .png, and gnuplot is there to draw it.
void checkChart(const std::string& file);

/// Quotes as gnuplot does.
std::string quoted(const std::string& text);

/// The commands that choose the file and its format, with the size in pixels.
std::string terminalOf(const std::string& file, double width, double height);

/// Runs a script that draws to `file`. Throws std::runtime_error if the file cannot be written, or if gnuplot is missing or
/// fails.
void runGnuplot(const std::string& file, const std::string& script);

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "sk-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error("cannot make a temporary folder '" + name + "'; set TMPDIR to a place for it");
    }
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace sk_tool
