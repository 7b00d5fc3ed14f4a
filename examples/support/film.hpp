// SPDX-License-Identifier: MIT
//
// Frames one after the other, to what the name of a file asks for: numbered PNG files, an animated PNG, or, by ffmpeg, a
// film.
#pragma once

#include <filesystem>
#include <memory>

#include "support/image.hpp"

namespace examples {

class Film {
 public:
  /// "waves.png": waves_0000.png, waves_0001.png ... "waves.apng": an animated PNG. "waves.gif", ".mp4", ".webm", ".mkv": a
  /// film by ffmpeg. Throws std::runtime_error for another ending, a file that cannot be written, and where ffmpeg is
  /// needed and not installed.
  Film(const std::filesystem::path& file, int framesPerSecond);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// Throws where a frame has another size than the first, and where it cannot be written.
  void add(const Image& image);
  /// Completes the file. Throws where that fails; the destructor gives up quietly.
  void finish();

  int frames() const { return frames_; }

  class Writer;  ///< film.cpp's own

 private:
  std::unique_ptr<Writer> writer_;
  int width_ = 0, height_ = 0;
  int frames_ = 0;
};

}  // namespace examples
