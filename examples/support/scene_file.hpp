// SPDX-License-Identifier: MIT
//
// Scenes: TOML files whose every key is asked for by name, so that a wrong one is told at its line and column, with the way out.
// It knows nothing of what scenes mean.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace examples {

/// Numbers that a key may have, both ends included.
struct Range {
  double least = std::numeric_limits<double>::lowest();
  double most = std::numeric_limits<double>::max();
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
