// SPDX-License-Identifier: MIT
#include "classics/support/classic.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace classics {
namespace {

/// The word as a size in the classic's range. Throws std::runtime_error.
int sizeOf(const Classic& classic, std::string_view word) {
  int size = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), size);
  if (error != std::errc{} || end != word.data() + word.size() || size < classic.smallest ||
      size > classic.largest) {
    throw std::runtime_error(
        fmt::format("'{}' is not a size; write a number from {} to {} ({}), and then a device if you like",
                    word, classic.smallest, classic.largest, classic.sizeIs));
  }
  return size;
}

std::string helpOf(const Classic& classic) {
  return fmt::format(
      "usage: {0} [SIZE] [DEVICE]\n\n"
      "{1}\n"
      "  SIZE    {2}, from {3} to {4} (default: {5})\n"
      "  DEVICE  native, gpu, software, ... as for SK_DEVICE (default: the best one)\n\n"
      "Pictures go to the current folder. The exit status is 1 after an error, or if a result misses its "
      "bound.\n",
      classic.name, classic.paper, classic.sizeIs, classic.smallest, classic.largest, classic.size);
}

double medianOf(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace

Run::Run(const Classic& classic, int size, const std::string& device)
    : classic_(classic), size_(size), device_(device.empty() ? sk::Device() : sk::Device(device)) {
  if (::access(".", W_OK) != 0)
    throw std::runtime_error("pictures go to the current folder, which is not writable");
  say("{}: {}, {} {}, on {}", classic.name, classic.paper, size, classic.sizeIs, device_.name());
}

void Run::print(const std::string& line) { std::printf("%s\n", line.c_str()); }

double Run::milliseconds(const std::function<void()>& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  device_.finish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double Run::timed(const std::function<void()>& body) {
  const double took = milliseconds(body);
  milliseconds_ += took;
  return took;
}

double Run::ratio(std::string_view what, const std::function<void()>& slow, const std::function<void()>& fast,
                  int rounds) {
  std::vector<double> slowTimes, fastTimes;
  for (int round = -1; round < rounds; ++round) {
    const double slowTime = milliseconds(slow), fastTime = milliseconds(fast);
    if (round < 0) continue;  // programs are compiled, and memory is touched
    slowTimes.push_back(slowTime);
    fastTimes.push_back(fastTime);
  }
  const double slowMedian = medianOf(slowTimes), fastMedian = medianOf(fastTimes),
               ratio = slowMedian / fastMedian;
  say("{}: {:.2f} times ({:.3g} ms, {:.3g} ms)", what, ratio, slowMedian, fastMedian);
  return ratio;
}

void Run::check(std::string_view what, double error, double bound, std::string_view reason) {
  const bool passed = error <= bound;   // false for NaN
  say("{}: error {:.2g}, allowed {:.2g} ({}){}", what, error, bound, reason, passed ? "" : ": TOO LARGE");
  failed_ = failed_ || !passed;
  const double share = bound > 0 ? error / bound : error > 0 ? std::numeric_limits<double>::infinity() : 0;
  const double shown = bound_ > 0 ? error_ / bound_ : error_;
  if (error_ < 0 || !(share <= shown)) {
    error_ = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
    bound_ = bound;
  }
}

void Run::picture(const std::string& file, const examples::Image& image) {
  examples::savePng(file, image);
  say("picture: {}", file);
  if (picture_.empty()) picture_ = file;
}

int Run::finish() {
  failed_ = failed_ || error_ < 0;
  say("| {} | {} | {} | {:.3g} ms | {} | {} |", classic_.name, classic_.paper, device_.name(), milliseconds_,
      error_ < 0 ? std::string("nothing was checked") : fmt::format("{:.2g}, allowed {:.2g}", error_, bound_),
      failed_ ? "FAILED" : picture_);
  if (std::fflush(stdout) != 0 || std::ferror(stdout))
    throw std::runtime_error("what is printed cannot be written");
  return failed_ ? 1 : 0;
}

double larger(double worst, double error) { return worst >= error || std::isnan(worst) ? worst : error; }

double largestDifference(std::span<const float> got, std::span<const double> expected) {
  if (got.size() != expected.size()) throw std::runtime_error("two results have different lengths");
  double largest = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    const double value = got[i], wanted = expected[i];
    if (value == wanted || (std::isnan(value) && std::isnan(wanted))) continue;
    const double difference = std::abs(value - wanted);
    if (std::isnan(difference)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, difference);
  }
  return largest;
}

double largestOf(std::span<const double> values) {
  double largest = 0;
  for (const double value : values) largest = larger(largest, std::abs(value));
  return largest;
}

examples::Image fieldPicture(std::span<const float> values, int rows, int columns, float low, float high,
                             std::string_view map, int scale, bool upwards) {
  const std::vector<sk::float3> colours = examples::colormap(map, 256);
  const auto width = static_cast<std::size_t>(columns) * static_cast<std::size_t>(scale);
  const auto height = static_cast<std::size_t>(rows) * static_cast<std::size_t>(scale);
  std::vector<sk::float3> pixels(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    const std::size_t row = upwards ? static_cast<std::size_t>(rows) - 1 - y / static_cast<std::size_t>(scale)
                                    : y / static_cast<std::size_t>(scale);
    for (std::size_t x = 0; x < width; ++x) {
      const float value =
          values[row * static_cast<std::size_t>(columns) + x / static_cast<std::size_t>(scale)];
      if (std::isnan(value)) continue;
      const float place = std::clamp((value - low) / std::max(high - low, 1e-30f), 0.0f, 1.0f);
      pixels[y * width + x] = colours[static_cast<std::size_t>(std::lround(place * 255))];
    }
  }
  return examples::imageOf(static_cast<int>(width), static_cast<int>(height), pixels);
}

examples::Image sideBySide(std::span<const examples::Image> images, int gap) {
  int width = -gap, height = 0;
  for (const examples::Image& image : images) {
    width += image.width + gap;
    height = std::max(height, image.height);
  }
  examples::Image all = examples::plainImage(width, height, {1, 1, 1});
  int x = 0;
  for (const examples::Image& image : images) {
    paste(all, image, x, 0);
    x += image.width + gap;
  }
  return all;
}

int run(int argc, char** argv, const Classic& classic, const std::function<void(Run&)>& body) {
  try {
    const std::vector<std::string_view> words(argv + 1, argv + argc);
    if (std::ranges::any_of(words, [](std::string_view word) { return word == "--help" || word == "-h"; })) {
      std::printf("%s", helpOf(classic).c_str());
      return 0;
    }
    if (words.size() > 2)
      throw std::runtime_error(
          fmt::format("'{}' is one argument too many; write a size and a device", words[2]));
    Run run(classic, words.empty() ? classic.size : sizeOf(classic, words[0]),
            words.size() > 1 ? std::string(words[1]) : std::string());
    body(run);
    return run.finish();
  } catch (const std::exception& error) {
    std::fflush(stdout);
    std::fprintf(stderr, "%s: %s\n", std::string(classic.name).c_str(), error.what());
    return 1;
  }
}

}  // namespace classics
