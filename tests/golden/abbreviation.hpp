// SPDX-License-Identifier: MIT
//
// Goldens of GLSL show what is particular to each program. Every abbreviation expands to exactly one text, so a
// golden fixes every byte of its programs:
//
//   ... float sk_rounded_sum(float a, float b) {   the text in library.glsl that begins with this line
//   ... program 3                                  the rest is the difference from program 3 of this golden,
//   ... program 3 of glsl330                       or of the golden for glsl330
//   ... 14 lines                                   the next 14 lines of that program, library texts counted as one
//   ... 14 lines after 2                           skips 2 of its lines first
//   #line 0                                        the number of the line that follows
#pragma once

#include <map>
#include <string>
#include <vector>

namespace golden {

/// Texts that stand in the programs of several .sk files, by their first lines.
class Library {
 public:
  Library() = default;
  explicit Library(const std::string& text);

  /// Collects the texts that the programs of two or more .sk files share. `outputs` holds, for each .sk file, what skc
  /// wrote for each profile.
  static Library of(const std::vector<std::vector<std::string>>& outputs);

  /// The library as a file, which the constructor reads.
  std::string text() const;

  /// The lines of each text, by the first of them.
  const std::map<std::string, std::vector<std::string>>& texts() const { return texts_; }

 private:
  std::map<std::string, std::vector<std::string>> texts_;
};

/// Abbreviates the programs that skc writes for one .sk file. `base` is the file's golden for glsl330; "" for glsl330 itself.
std::string abbreviated(const std::string& output, const std::string& base, const Library& library);

/// Recovers the output of skc from a golden. Throws std::runtime_error if the golden names something that does not exist.
std::string expanded(const std::string& golden, const std::string& base, const Library& library);

}  // namespace golden
