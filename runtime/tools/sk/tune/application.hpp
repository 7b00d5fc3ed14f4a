// SPDX-License-Identifier: MIT
//
// Runs the program that is tuned, without its output, and collects what it read and how long its kernels took.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "application/process.hpp"
#include "results/results_file.hpp"

namespace sk_tool::tune {

/// A file that the program writes, and whose numbers count: a picture, a .npy file, or the numbers at a path in a JSON file.
struct ResultFile {
  std::string file;
  std::string path = {};  ///< of a JSON file: "energy", "run.steps.3"

  /// "picture.png", or "run.json:energy".
  std::string name() const { return path.empty() ? file : file + ":" + path; }
  bool isPicture() const;
};

/// The numbers of a result file; pictures have components from 0 to 1. Throws std::runtime_error if it cannot be read.
sk::results::Series seriesOf(const ResultFile& file);

/// The components of a PNG, JPEG, BMP or TGA file, from 0 to 1. Throws std::runtime_error if it cannot be read, or if sk was built without
/// stb.
std::vector<double> pictureIn(const std::string& file);

struct RunOptions {
  EnvironmentChanges environment = {};
  bool measures = false;  ///< wait around each kernel on devices that queue calls
  std::chrono::duration<double> limit = std::chrono::hours(24);
};

struct RunResult {
  std::string failure = {};  ///< why there are no results; empty if there are
  bool isTooSlow = false;  ///< it was ended at the limit
  sk::results::Process process = {};
  double wall = 0;  ///< seconds

  /// The seconds of its kernels; if these are not known, those from the first device to the last read.
  double seconds() const;
};

class Application {
 public:
  /// `words` are the program and its arguments. With `anyStatus`, a program that exits has run, whatever its status.
  Application(std::vector<std::string> words, std::vector<ResultFile> files, bool anyStatus = false)
      : words_(std::move(words)), files_(std::move(files)), anyStatus_(anyStatus) {}

  const std::vector<std::string>& words() const { return words_; }
  const std::vector<ResultFile>& files() const { return files_; }
  /// The program's name for messages.
  std::string name() const { return "'" + words_.front() + "'"; }

  /// Throws std::runtime_error if there is no such program.
  RunResult run(const RunOptions& options) const;

 private:
  std::vector<std::string> words_;
  std::vector<ResultFile> files_;
  bool anyStatus_;
};

}  // namespace sk_tool::tune
