// SPDX-License-Identifier: MIT
//
// Scenes: TOML files whose every key is asked for by name, so that a wrong one is told at its line and column, with the way out.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <sk/options.hpp>

#include "support/vec.hpp"

namespace examples {

/// Numbers that a key may have, both ends included.
struct Range {
  double least = std::numeric_limits<double>::lowest();
  double most = std::numeric_limits<double>::max();
};

/// Precisions as scenes and command lines name them.
inline constexpr std::array<std::string_view, 4> precisionNames = {"half", "single", "extended", "double"};
/// The names of the precisions that most devices have.
inline constexpr std::array<std::string_view, 2> commonPrecisions = {"single", "double"};
/// The precision with one of these names.
sk::Precision precisionNamed(std::string_view name);
/// Default is "single".
std::string_view nameOf(sk::Precision precision);

/// What the command line says in place of a scene.
struct SceneOverrides {
  std::vector<std::int64_t> size;  ///< cells along x, y and, in space, z; as many as are given
  std::optional<std::int64_t> steps;
  std::optional<sk::Precision> precision;
};

/// A table of a scene. Asking for a key marks it as known; `none` where the scene has it not. Everything throws
/// std::runtime_error, "FILE:LINE:COLUMN: what is wrong", where a key has another type or a value that is not allowed.
class SceneTable {
 public:
  bool has(std::string_view key) const;
  std::optional<SceneTable> table(std::string_view key) const;
  /// The tables [[key]] in the order of the file; an empty list if there are none.
  std::vector<SceneTable> tables(std::string_view key) const;

  /// Integers are numbers, too. NaN and infinities are refused.
  std::optional<double> number(std::string_view key, const Range& range = {}) const;
  std::optional<std::int64_t> integer(std::string_view key, const Range& range = {}) const;
  std::optional<bool> flag(std::string_view key) const;
  std::optional<std::string> text(std::string_view key) const;
  /// An array of so many numbers; -1: any count.
  std::optional<std::vector<double>> numbers(std::string_view key, int count, const Range& range = {}) const;
  /// The number of a name in a list.
  std::optional<std::size_t> choice(std::string_view key, std::span<const std::string_view> names) const;

  /// Three numbers, as large as squares of floats may be.
  std::optional<Vector> vector(std::string_view key) const;
  /// A vector of unit length; a zero vector is refused.
  std::optional<Vector> direction(std::string_view key) const;
  /// One of `names`, which are those of precisionNames or some of them.
  std::optional<sk::Precision> precision(std::string_view key, std::span<const std::string_view> names) const;

  /// Sets `value` to what the key has; it stays where the table has none.
  template <class T>
  void read(std::string_view key, T& value, const Range& range = {}) const {
    if constexpr (std::is_same_v<T, bool>)
      value = flag(key).value_or(value);
    else if constexpr (std::is_integral_v<T>)
      value = static_cast<T>(integer(key, range).value_or(static_cast<std::int64_t>(value)));
    else
      value = number(key, range).value_or(value);
  }
  void read(std::string_view key, std::string& value) const { value = text(key).value_or(value); }
  void read(std::string_view key, Vector& value) const { value = vector(key).value_or(value); }
  /// Names are those of the enumerators, from 0 on.
  template <class Enum>
    requires std::is_enum_v<Enum>
  void read(std::string_view key, Enum& value, std::span<const std::string_view> names) const {
    value = static_cast<Enum>(choice(key, names).value_or(static_cast<std::size_t>(value)));
  }

  /// Throws where something else is wrong with a key, or with its absence.
  [[noreturn]] void fail(std::string_view key, std::string_view message) const;
  /// As `fail`, with a sentence that begins with the name of the key.
  [[noreturn]] void refuse(std::string_view key, std::string_view what) const;
  /// Throws for the first key, of this table or one below, that nobody has asked for.
  void finish() const;

 private:
  friend SceneTable loadScene(const std::filesystem::path& file);
  struct Document;
  struct Access;  ///< what knows the parser's types
  SceneTable(std::shared_ptr<Document> document, const void* table)
      : document_(std::move(document)), table_(table) {}

  std::shared_ptr<Document> document_;  ///< that all tables of a file share
  const void* table_;
};

/// Reads a whole scene. Throws std::runtime_error where the file is missing or no TOML.
SceneTable loadScene(const std::filesystem::path& file);

}  // namespace examples
