// SPDX-License-Identifier: MIT
//
// Animated PNG (W3C, "PNG Specification, Third Edition", section 11.3.6): the frames of a film in one file that browsers show,
// without loss, and that programs which know none of it show the first frame of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "support/image.hpp"

namespace examples {

class AnimatedPng {
 public:
  /// Opens the file. Throws std::runtime_error where it cannot be written.
  AnimatedPng(const std::filesystem::path& file, int framesPerSecond);

  /// All frames have the size of the first.
  void add(const Image& image);
  /// Repeats for ever. Throws where something was not written.
  void finish();

 private:
  void begin(const Image& image);
  void writeChunk(std::string_view type, std::string_view data);

  std::filesystem::path name_;
  std::fstream file_;
  int framesPerSecond_;
  std::uint32_t frames_ = 0;
  std::uint32_t sequence_ = 0;  ///< of the next chunk that has a number
  std::streampos control_ = 0;  ///< of the chunk that tells the number of frames
};

}  // namespace examples
