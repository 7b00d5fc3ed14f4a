// SPDX-License-Identifier: MIT
//
// How far a long measurement is, on a terminal; nothing elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace sk_tool {

class Progress {
 public:
  explicit Progress(std::string what);
  /// Removes the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// The part that is done, from 0 to 1; shown several times a second.
  void show(double done);

 private:
  std::string what_;
  bool isShown_;
  std::chrono::steady_clock::time_point last_ = {};
};

}  // namespace sk_tool
