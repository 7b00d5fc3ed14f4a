// SPDX-License-Identifier: MIT
//
// What the main functions of the classics share: two arguments, lines of text, pictures, checks, and the row of the demo's table. It
// knows no kernel, and it opens the device that the second argument names.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "support/colormap.hpp"
#include "support/image.hpp"

namespace classics {

/// What a classic says about itself. All texts are literals.
struct Classic {
  std::string_view name;  ///< of the program
  std::string_view paper;  ///< "Carr, Hall, Hart 2002"
  std::string_view sizeIs;  ///< what SIZE counts: "pixels along a side"
  int size;  ///< the default: a few seconds on two cores
  int smallest, largest;  ///< the range of SIZE, ends included
};

/// One run of a classic.
class Run {
 public:
  Run(const Classic& classic, int size, const std::string& device);

  int size() const { return size_; }
  sk::Device& device() { return device_; }

  /// Prints a line.
  template <class... T>
  void say(fmt::format_string<T...> format, T&&... arguments) {
    print(fmt::format(format, std::forward<T>(arguments)...));
  }

  /// Calls `body`, waits for the device, and returns the milliseconds that passed.
  double milliseconds(const std::function<void()>& body);
  /// The same, for what the row of the table gives as the classic's time; the times of several calls add up.
  double timed(const std::function<void()>& body);
  /// The median time of `slow` divided by that of `fast`, each called in turn `rounds` times, after one round that is not
  /// counted. Prints it with both medians: "WHAT: 1.83 times (12.1 ms, 6.6 ms)". Results depend on the device, so READMEs quote
  /// it with the device's name.
  double ratio(std::string_view what, const std::function<void()>& slow, const std::function<void()>& fast,
               int rounds = 5);

  /// Compares a result with what plain loops in double found. Prints both numbers; an error over the bound, or one that is not a number, makes the
  /// program end with status 1. `reason` says where the bound comes from. The row of the table has the check that came closest to its bound.
  void check(std::string_view what, double error, double bound, std::string_view reason);

  /// Saves a picture as FILE in the current folder and prints its name. The first one is in the row of the table.
  void picture(const std::string& file, const examples::Image& image);

  /// Prints the row and returns the exit status.
  int finish();

 private:
  void print(const std::string& line);

  const Classic& classic_;
  int size_;
  sk::Device device_;
  double milliseconds_ = 0;
  bool failed_ = false;
  double error_ = -1, bound_ = 1;  ///< error_ < 0: nothing was checked, which is a failure
  std::string picture_;
};

/// The larger of two errors; NaN if one of them is NaN, which std::max would lose.
double larger(double worst, double error);
/// The largest of |got[i] - expected[i]|, infinite if a value is NaN where the other is not. Both have the same length.
double largestDifference(std::span<const float> got, std::span<const double> expected);
/// The largest of |values[i]|; NaN if a value is NaN.
double largestOf(std::span<const double> values);

/// A field of rows x columns values as a picture: each value's place between low and high chooses a colour of a map (colormap.hpp), and each
/// value is a square of `scale` x `scale` pixels. Row 0 is at the bottom if `upwards`, else at the top. NaN is black.
examples::Image fieldPicture(std::span<const float> values, int rows, int columns, float low, float high,
                             std::string_view map = "ember", int scale = 1, bool upwards = false);
/// Pictures of one height side by side, with `gap` white pixels in between.
examples::Image sideBySide(std::span<const examples::Image> images, int gap = 8);

/// Parses [SIZE] [DEVICE] and --help, runs `body`, and turns an exception into one line on standard error. Returns main's exit status.
int run(int argc, char** argv, const Classic& classic, const std::function<void(Run&)>& body);

}  // namespace classics
