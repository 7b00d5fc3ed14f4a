// SPDX-License-Identifier: MIT
//
// Settings: what a trial changes in a configuration file, and the texts of such files (docs/accuracy.md, "Where to choose").
#pragma once

#include <compare>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sk_tool::tune {

/// One key of a configuration file: [kernels."heat::diffuse"] precision.
struct Unit {
  std::string section;  ///< "kernels" or "streams"
  std::string name;
  std::string key;

  auto operator<=>(const Unit&) const = default;
};

/// Values by unit, without quotes: "double".
using Setting = std::map<Unit, std::string>;

/// "heat::diffuse: precision single"; streams without a name are "streams without a name".
std::string describe(const Unit& unit, const std::string& value);
/// All units of a setting, in one line; "nothing changed" if there is none.
std::string describe(const Setting& setting);

/// The first setting, changed by the second.
Setting with(Setting first, const Setting& second);
/// The first setting without the units of the second.
Setting without(Setting first, const Setting& second);

/// What a file must know of the program.
struct ProgramFacts {
  /// The choices of kernels that their calls make themselves, "precision double", or that exclude others: the table of such a kernel
  /// gets `force = true` if a setting changes one, and loses keys that calls override anyway.
  std::map<std::string, std::vector<std::string>> called = {};
  /// Named streams and their storage. A choice for streams without a name, "*", leaves these as they are.
  std::map<std::string, std::string> streams = {};
};

/// What goes into a file beside the values.
struct FileTexts {
  std::string head = {};  ///< comment lines before all tables
  /// The comment at the end of a unit's line; may be empty.
  std::function<std::string(const Unit&)> comment = {};
};

/// The configuration file from which a search starts; empty without one.
class BaseFile {
 public:
  BaseFile() = default;
  /// Throws std::runtime_error if the file cannot be read or is no TOML.
  explicit BaseFile(const std::string& file);

  const std::string& name() const { return name_; }
  /// The names in a section, without "*".
  std::vector<std::string> namesIn(const std::string& section) const;
  /// The value of a unit, or of its kernel "*".
  std::optional<std::string> valueOf(const Unit& unit) const;

  /// The file with a setting.
  std::string text(const Setting& setting, const ProgramFacts& facts, const FileTexts& texts = {}) const;

 private:
  using Keys = std::map<std::string, std::string>;  ///< to values as TOML writes them

  std::string name_;
  std::map<std::string, std::map<std::string, Keys>> sections_;
};

}  // namespace sk_tool::tune
