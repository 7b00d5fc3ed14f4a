// SPDX-License-Identifier: MIT
//
// Layout: a line with the version, lines of the identity, an empty line; then numbers as they lie in memory: passes, pixels, whether some have
// stopped, sums, squares, counts, active; then a hash of all before it.
#include "state_file.hpp"

#include <array>
#include <cstring>
#include <fstream>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace rays {
namespace {

constexpr std::string_view format = "rays state 1";

[[noreturn]] void refuseState(const std::filesystem::path& file, std::string_view what) {
  throw std::runtime_error(fmt::format("the state '{}' {}", file.string(), what));
}

/// FNV-1a of 64 bits, of 8 bytes at a time.
class Hash {
 public:
  void add(std::span<const std::byte> bytes) {
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + i, 8);
      mix(word);
    }
    for (; i < bytes.size(); ++i) mix(static_cast<std::uint64_t>(bytes[i]));
  }
  /// T is a struct of 4-byte numbers without padding, so that equal elements have equal bytes.
  template <class T>
  void addAll(const std::vector<T>& elements) {
    add(std::as_bytes(std::span(elements)));
    mix(elements.size());
  }
  void addText(std::string_view text) { add(std::as_bytes(std::span(text))); }
  std::uint64_t value() const { return value_; }

 private:
  void mix(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x100000001b3u;
    value_ ^= value_ >> 29;
  }

  std::uint64_t value_ = 0xcbf29ce484222325u;
};

std::string textOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// What the files have that a scene names.
std::uint64_t hashOf(const Model& model) {
  Hash hash;
  hash.addAll(model.triangles);
  hash.addAll(model.corners);
  hash.addAll(model.spheres);
  hash.addAll(model.planes);
  for (const Material& m : model.materials) {
    const std::vector<float> numbers = {m.colour.x,
                                        m.colour.y,
                                        m.colour.z,
                                        m.emission.x,
                                        m.emission.y,
                                        m.emission.z,
                                        m.ior,
                                        m.roughness,
                                        float(m.scattering),
                                        float(m.texture),
                                        m.glowsBehind ? 1.0f : 0.0f};
    hash.addAll(numbers);
  }
  for (const Raster& texture : model.textures) hash.addAll(texture.pixels);
  hash.addAll(model.environment.image.pixels);
  return hash.value();
}

template <class T>
void append(std::string& bytes, std::span<const T> elements) {
  bytes.append(reinterpret_cast<const char*>(elements.data()), elements.size_bytes());
}

/// Reads numbers from the front of `bytes`.
class Reader {
 public:
  Reader(const std::filesystem::path& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  template <class T>
  std::vector<T> take(std::size_t count) {
    if (bytes_.size() / sizeof(T) < count) refuseState(file_, "ends too early; delete it to begin anew");
    std::vector<T> elements(count);
    std::memcpy(elements.data(), bytes_.data(), count * sizeof(T));
    bytes_.remove_prefix(count * sizeof(T));
    return elements;
  }

 private:
  const std::filesystem::path& file_;
  std::string_view bytes_;
};

std::string headOf(const Identity& identity) {
  std::string head(format);
  for (const std::string& line : identity.lines) head += "\n" + line;
  return head + "\n\n";
}

/// The first difference, which is what somebody has changed.
void compare(const std::filesystem::path& file, std::string_view found, const Identity& wanted) {
  std::istringstream lines{std::string(found)};
  std::string line;
  std::getline(lines, line);
  for (const std::string& expected : wanted.lines) {
    if (!std::getline(lines, line)) line = "nothing";
    if (line != expected)
      refuseState(
          file,
          fmt::format(
              "is of another picture: it has {}, and this one {}; name another file, or delete that one",
              line, expected));
  }
}

}  // namespace

Identity identityOf(const Scene& scene, const std::string& device) {
  const Picture& p = scene.picture;
  Hash text;
  text.addText(textOf(scene.file));
  return {{fmt::format("size {} x {}", p.width, p.height), fmt::format("engine {}", scene.engine),
           scene.output.error > 0
               ? fmt::format("error {} from {} samples on", scene.output.error, scene.output.least)
               : std::string("no error to reach"),
           fmt::format("device {}", device), fmt::format("scene text {:016x}", text.value()),
           fmt::format("meshes and images {:016x}", hashOf(scene.model))}};
}

void saveState(const std::filesystem::path& file, const Identity& identity, const Gathered& gathered) {
  std::string bytes = headOf(identity);
  const std::array<std::int64_t, 3> sizes = {gathered.passes, static_cast<std::int64_t>(gathered.sums.size()),
                                             gathered.active.empty() ? 0 : 1};
  append(bytes, std::span<const std::int64_t>(sizes));
  append(bytes, std::span(gathered.sums));
  append(bytes, std::span(gathered.squares));
  append(bytes, std::span(gathered.counts));
  append(bytes, std::span(gathered.active));
  Hash hash;
  hash.addText(bytes);
  const std::array<std::uint64_t, 1> sum = {hash.value()};
  append(bytes, std::span<const std::uint64_t>(sum));

  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  std::filesystem::path beside = file;
  beside += ".new";
  std::ofstream stream(beside, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (stream) std::filesystem::rename(beside, file, error);
  if (!stream || error) refuseState(file, "cannot be written");
}

Gathered loadState(const std::filesystem::path& file, const Identity& identity) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) refuseState(file, "is no file; name another one");
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad() || bytes.empty()) refuseState(file, "cannot be read, or is empty");
  if (!bytes.starts_with("rays state ")) refuseState(file, "is no state of a picture; name another file");
  if (!bytes.starts_with(std::string(format) + "\n"))
    refuseState(
        file,
        fmt::format("is of another version of this program, which reads '{}'; name another file", format));
  const std::size_t end = bytes.find("\n\n");
  if (end == std::string::npos || bytes.size() < end + 10)
    refuseState(file, "ends too early; delete it to begin anew");
  compare(file, std::string_view(bytes).substr(0, end), identity);

  const std::string_view all = std::string_view(bytes).substr(0, bytes.size() - 8);
  Hash hash;
  hash.addText(all);
  if (Reader(file, std::string_view(bytes).substr(all.size())).take<std::uint64_t>(1)[0] != hash.value())
    refuseState(file, "is damaged; delete it to begin anew");
  Reader reader(file, all.substr(end + 2));
  const std::vector<std::int64_t> sizes = reader.take<std::int64_t>(3);
  const auto pixels = static_cast<std::size_t>(sizes[1]);
  Gathered gathered{sizes[0], reader.take<sk::double3>(pixels), reader.take<sk::double3>(pixels), {}, {}};
  if (sizes[2] != 0) {
    gathered.counts = reader.take<int>(pixels);
    gathered.active = reader.take<int>(pixels);
  }
  return gathered;
}

}  // namespace rays
