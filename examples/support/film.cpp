// SPDX-License-Identifier: MIT
#include "support/film.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <stb/stb_image_write.h>
#include <unistd.h>

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

constexpr std::size_t signatureBytes = 8;

std::string bigEndian(std::uint32_t value, int bytes = 4) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>((value >> (8 * i)) & 0xff);
  return text;
}

std::uint32_t numberAt(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = (value << 8) | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// The CRC of ISO 3309 that ends every chunk.
std::uint32_t checksum(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t n = 0; n < 256; ++n) {
      std::uint32_t c = n;
      for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
      made[n] = c;
    }
    return made;
  }();
  std::uint32_t c = 0xffffffffu;
  for (const char byte : bytes) c = table[(c ^ static_cast<unsigned char>(byte)) & 0xff] ^ (c >> 8);
  return c ^ 0xffffffffu;
}

/// A PNG of its own, of which a frame takes the compressed pixels.
std::string encoded(const Image& image) {
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(), image.width * 3);
  return bytes;
}

/// Calls visit(type, data) for each chunk of a PNG.
template <class Visit>
void forEachChunk(std::string_view png, Visit&& visit) {
  for (std::size_t at = signatureBytes; at + 12 <= png.size();) {
    const std::size_t length = numberAt(png, at);
    visit(png.substr(at + 4, 4), png.substr(at + 8, length));
    at += length + 12;
  }
}

/// Animated PNG (W3C, "PNG Specification, Third Edition", section 11.3.6): the frames of a film in one file that browsers show,
/// without loss, and that programs which know none of it show the first frame of.
class AnimatedFile final : public Film::Writer {
 public:
  AnimatedFile(const fs::path& file, int framesPerSecond) : name_(file), framesPerSecond_(framesPerSecond) {
    std::error_code ignored;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), ignored);
    file_.open(file, std::ios::out | std::ios::binary | std::ios::trunc);
    if (!file_) {
      throw std::runtime_error(
          fmt::format("cannot write '{}'; name a file in a folder that can be written", file.string()));
    }
  }

  void add(const Image& image, int number) override {
    if (number == 0) begin(image);
    writeChunk("fcTL", bigEndian(sequence_++) + bigEndian(static_cast<std::uint32_t>(image.width)) +
                           bigEndian(static_cast<std::uint32_t>(image.height)) + bigEndian(0) + bigEndian(0) +
                           bigEndian(1, 2) + bigEndian(static_cast<std::uint32_t>(framesPerSecond_), 2) +
                           '\0' + '\0');
    forEachChunk(encoded(image), [&](std::string_view type, std::string_view data) {
      if (type != "IDAT") return;
      if (number == 0) {
        writeChunk(type, data);
      } else {
        writeChunk("fdAT", bigEndian(sequence_++) + std::string(data));
      }
    });
    ++frames_;
  }
  /// Repeats for ever.
  void finish() override {
    if (frames_ > 0) {
      writeChunk("IEND", "");
      file_.seekp(control_);
      writeChunk("acTL", bigEndian(frames_) + bigEndian(0));
    }
    file_.close();
    if (!file_)
      throw std::runtime_error(fmt::format("'{}' could not be written; is the disk full?", name_.string()));
  }

 private:
  void begin(const Image& image) {
    const std::string png = encoded(image);
    file_.write(png.data(), signatureBytes);
    forEachChunk(png, [&](std::string_view type, std::string_view data) {
      if (type == "IHDR") writeChunk(type, data);
    });
    control_ = file_.tellp();
    writeChunk("acTL", bigEndian(0) + bigEndian(0));
  }
  void writeChunk(std::string_view type, std::string_view data) {
    const std::string body = std::string(type) + std::string(data);
    file_ << bigEndian(static_cast<std::uint32_t>(data.size())) << body << bigEndian(checksum(body));
  }

  fs::path name_;
  std::fstream file_;
  int framesPerSecond_;
  std::uint32_t frames_ = 0;
  std::uint32_t sequence_ = 0;  ///< of the next chunk that has a number
  std::streampos control_ = 0;  ///< of the chunk that tells the number of frames
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
