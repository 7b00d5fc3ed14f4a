// SPDX-License-Identifier: MIT
#include "support/film.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "support/animated_png.hpp"

namespace examples {

namespace fs = std::filesystem;

class Film::Writer {
 public:
  virtual ~Writer() = default;
  virtual void add(const Image& image, int number) = 0;
  virtual void finish() = 0;
};

namespace {

class NumberedFiles final : public Film::Writer {
 public:
  explicit NumberedFiles(const fs::path& file) : file_(file) {}

  void add(const Image& image, int number) override {
    const std::string name = fmt::format("{}_{:04}.png", file_.stem().string(), number);
    savePng(file_.parent_path() / name, image);
  }
  void finish() override {}

 private:
  fs::path file_;
};

class AnimatedFile final : public Film::Writer {
 public:
  AnimatedFile(const fs::path& file, int framesPerSecond) : png_(file, framesPerSecond) {}

  void add(const Image& image, int) override { png_.add(image); }
  void finish() override { png_.finish(); }

 private:
  AnimatedPng png_;
};

/// Whether PATH has a program of this name.
bool isInstalled(std::string_view program) {
  const char* variable = std::getenv("PATH");
  std::string_view folders = variable == nullptr ? "" : variable;
  while (!folders.empty()) {
    const std::size_t end = std::min(folders.find(':'), folders.size());
    if (access((fs::path(folders.substr(0, end)) / program).c_str(), X_OK) == 0) return true;
    folders.remove_prefix(std::min(end + 1, folders.size()));
  }
  return false;
}

/// As one word of the shell's.
std::string quoted(const std::string& text) {
  std::string made = "'";
  for (const char c : text) made += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return made + "'";
}

/// What ffmpeg is told of the kinds of films: codecs that players everywhere know, and for GIF the best palette.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kinds{{
    {".mp4", "-c:v libx264 -pix_fmt yuv420p -crf 18 -movflags +faststart"},
    {".mkv", "-c:v libx264 -pix_fmt yuv420p -crf 18"},
    {".webm", "-c:v libvpx-vp9 -pix_fmt yuv420p -crf 24 -b:v 0"},
    {".gif", "-filter_complex '[0:v]split[a][b];[a]palettegen[p];[b][p]paletteuse' -loop 0"},
}};

/// Raw frames through a pipe to ffmpeg, which is started with the first, whose size it must know.
class PipedFilm final : public Film::Writer {
 public:
  PipedFilm(const fs::path& file, std::string_view options, int framesPerSecond)
      : file_(file), options_(options), framesPerSecond_(framesPerSecond) {
    if (!isInstalled("ffmpeg")) {
      throw std::runtime_error(fmt::format(
          "'{}' takes ffmpeg, which is not installed; install it, or name a file that ends in .apng or .png",
          file.string()));
    }
    std::error_code ignored;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), ignored);
    std::signal(SIGPIPE,
                SIG_IGN);  // an ffmpeg that ends early is an error of fwrite's, not this program's end
  }
  ~PipedFilm() override {
    if (pipe_ != nullptr) pclose(pipe_);
  }

  void add(const Image& image, int number) override {
    if (number == 0) start(image);
    if (std::fwrite(image.rgb.data(), 1, image.rgb.size(), pipe_) != image.rgb.size()) fail();
  }
  void finish() override {
    if (pipe_ != nullptr && pclose(std::exchange(pipe_, nullptr)) != 0) fail();
  }

 private:
  void start(const Image& image) {
    const std::string command = fmt::format(
        "ffmpeg -y -loglevel error -f rawvideo -pix_fmt rgb24 -video_size {}x{} -framerate {} -i - {} {}",
        image.width, image.height, framesPerSecond_, options_, quoted(fs::absolute(file_).string()));
    pipe_ = popen(command.c_str(), "w");
    if (pipe_ == nullptr) fail();
  }
  [[noreturn]] void fail() const {
    throw std::runtime_error(
        fmt::format("ffmpeg could not write '{}'; what it says is above", file_.string()));
  }

  fs::path file_;
  std::string options_;
  int framesPerSecond_;
  std::FILE* pipe_ = nullptr;
};

std::unique_ptr<Film::Writer> writerFor(const fs::path& file, int framesPerSecond) {
  const std::string ending = file.extension().string();
  if (ending == ".png") return std::make_unique<NumberedFiles>(file);
  if (ending == ".apng") return std::make_unique<AnimatedFile>(file, framesPerSecond);
  for (const auto& [known, options] : kinds) {
    if (ending == known) return std::make_unique<PipedFilm>(file, options, framesPerSecond);
  }
  throw std::runtime_error(fmt::format(
      "'{}' is no film; its name must end in .png, .apng, .mp4, .mkv, .webm or .gif", file.string()));
}

}  // namespace

Film::Film(const fs::path& file, int framesPerSecond) : writer_(writerFor(file, framesPerSecond)) {}
Film::~Film() = default;

void Film::add(const Image& image) {
  if (frames_ == 0) {
    width_ = image.width;
    height_ = image.height;
  } else if (image.width != width_ || image.height != height_) {
    throw std::runtime_error(fmt::format("a frame of {} x {} pixels in a film of {} x {}", image.width,
                                         image.height, width_, height_));
  }
  writer_->add(image, frames_++);
}

void Film::finish() { writer_->finish(); }

}  // namespace examples
