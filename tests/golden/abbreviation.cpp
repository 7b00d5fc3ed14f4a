// SPDX-License-Identifier: MIT
#include "abbreviation.hpp"

#include <algorithm>
#include <limits>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace golden {

namespace {

using Lines = std::vector<std::string>;

constexpr std::string_view mark = "... ";

Lines linesOf(const std::string& text) {
  Lines lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string textOf(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// The lines of each program, which begins with #version.
std::vector<Lines> programsOf(const std::string& text) {
  std::vector<Lines> programs;
  for (const std::string& line : linesOf(text)) {
    if (line.starts_with("#version")) programs.emplace_back();
    if (programs.empty()) throw std::runtime_error("'" + line + "' stands before the first program");
    programs.back().push_back(line);
  }
  return programs;
}

/// Whether a text that may be in the library begins with this line: a function of several lines, or a part of the head.
bool beginsText(const std::string& line) {
  static const std::regex function(R"(\w+ \w+\(.*[{,])");
  return line == "precision highp float;" || line.starts_with("#define sk_precise") ||
         (std::regex_match(line, function) && !line.starts_with("void main("));
}

/// The end of the text that begins at `begin`: behind the brace of a function, or before an empty line.
std::size_t endOfText(const Lines& lines, std::size_t begin) {
  const bool isFunction = lines[begin].find('(') != std::string::npos;
  std::size_t end = begin + 1;
  while (end < lines.size() && lines[end] != (isFunction ? "}" : "")) ++end;
  return isFunction ? std::min(end + 1, lines.size()) : end;
}

Lines part(const Lines& lines, std::size_t begin, std::size_t end) {
  return Lines(lines.begin() + begin, lines.begin() + end);
}

Lines withoutOwnNumbers(const Lines& program) {
  static const std::regex line(R"(#line \d+ 0)");
  Lines result = program;
  for (std::string& text : result) {
    if (std::regex_match(text, line)) text = "#line 0";
  }
  return result;
}

Lines withOwnNumbers(Lines program) {
  for (std::size_t i = 0; i < program.size(); ++i) {
    if (program[i] == "#line 0") program[i] = "#line " + std::to_string(i + 2) + " 0";
  }
  return program;
}

Lines withReferences(const Lines& program, const Library& library) {
  Lines result;
  for (std::size_t i = 0; i < program.size();) {
    const auto known = library.texts().find(program[i]);
    const std::size_t end = known != library.texts().end() ? endOfText(program, i) : i + 1;
    const bool isKnown = known != library.texts().end() && part(program, i, end) == known->second;
    if (!isKnown) {
      result.push_back(program[i++]);
      continue;
    }
    result.push_back(std::string(mark) + program[i]);
    i = end;
  }
  return result;
}

Lines withoutReferences(const Lines& program, const Library& library) {
  Lines result;
  for (const std::string& line : program) {
    if (!line.starts_with(mark)) {
      result.push_back(line);
      continue;
    }
    const auto known = library.texts().find(line.substr(mark.size()));
    if (known == library.texts().end()) throw std::runtime_error("library.glsl has no '" + line + "'");
    result.insert(result.end(), known->second.begin(), known->second.end());
  }
  return result;
}

/// The fewest lines that describe `program` by its difference from `base`.
Lines difference(const Lines& program, const Lines& base) {
  const std::size_t n = program.size(), m = base.size();
  // How many lines describe program[i...] by base[j...], between two runs of common lines and inside one.
  const std::vector<std::size_t> row(m + 1, std::numeric_limits<std::size_t>::max() / 2);
  std::vector<std::vector<std::size_t>> between(n + 1, row), inside(n + 1, row);
  between[n].assign(m + 1, 0);
  inside[n].assign(m + 1, 0);
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t j = m + 1; j-- > 0;) {
      const bool isCommon = j < m && program[i] == base[j];
      between[i][j] = 1 + between[i + 1][j];
      if (j < m) between[i][j] = std::min(between[i][j], between[i][j + 1]);
      if (isCommon) between[i][j] = std::min(between[i][j], 1 + inside[i + 1][j + 1]);
      inside[i][j] = std::min(between[i][j], isCommon ? inside[i + 1][j + 1] : row[0]);
    }
  }
  Lines result;
  std::size_t skipped = 0;
  for (std::size_t i = 0, j = 0; i < n;) {
    if (between[i][j] == 1 + between[i + 1][j]) {
      result.push_back(program[i++]);
    } else if (j < m && between[i][j] == between[i][j + 1]) {
      ++j;
      ++skipped;
    } else {
      std::size_t count = 0;
      do {
        ++i, ++j, ++count;
      } while (i < n && j < m && program[i] == base[j] && inside[i][j] == inside[i + 1][j + 1]);
      result.push_back(std::string(mark) + std::to_string(count) + " lines" +
                       (skipped > 0 ? " after " + std::to_string(skipped) : ""));
      skipped = 0;
    }
  }
  return result;
}

/// The program that `difference` describes. References to the library stay.
Lines applied(const Lines& difference, const Lines& base) {
  static const std::regex run(R"(\.\.\. (\d+) lines(?: after (\d+))?)");
  Lines result;
  std::size_t at = 0;
  for (const std::string& line : difference) {
    std::smatch match;
    if (!std::regex_match(line, match, run)) {
      result.push_back(line);
      continue;
    }
    at += match[2].matched ? std::stoul(match[2]) : 0;
    const std::size_t count = std::stoul(match[1]);
    if (at + count > base.size()) throw std::runtime_error("'" + line + "' goes beyond the program's end");
    result.insert(result.end(), base.begin() + at, base.begin() + at + count);
    at += count;
  }
  return result;
}

/// The programs of a golden with their differences applied, and still with references to the library.
std::vector<Lines> whole(const std::string& golden, const std::vector<Lines>& base) {
  static const std::regex head(R"(\.\.\. program (\d+)( of glsl330)?)");
  std::vector<Lines> programs;
  for (const Lines& lines : programsOf(golden)) {
    std::smatch match;
    if (lines.size() < 3 || !std::regex_match(lines[2], match, head)) {
      programs.push_back(lines);
      continue;
    }
    const std::vector<Lines>& others = match[2].matched ? base : programs;
    const std::size_t number = std::stoul(match[1]);
    if (number < 1 || number > others.size()) throw std::runtime_error("'" + lines[2] + "' is not there");
    const Lines rest =
        applied(part(lines, 3, lines.size()), part(others[number - 1], 2, others[number - 1].size()));
    programs.push_back(part(lines, 0, 2));
    programs.back().insert(programs.back().end(), rest.begin(), rest.end());
  }
  return programs;
}

}  // namespace

Library::Library(const std::string& text) {
  const Lines lines = linesOf(text);
  for (std::size_t i = 0; i < lines.size();) {
    const std::size_t end = beginsText(lines[i]) ? endOfText(lines, i) : i + 1;
    if (beginsText(lines[i])) texts_[lines[i]] = part(lines, i, end);
    i = end;
  }
}

std::string Library::text() const {
  std::string text =
      "// SPDX-License-Identifier: MIT\n//\n"
      "// What programs of several .sk files have in common. SK_UPDATE_GOLDENS=1 writes it anew.\n";
  for (const auto& [first, lines] : texts_) text += "\n" + textOf(lines);
  return text;
}

Library Library::of(const std::vector<std::vector<std::string>>& outputs) {
  std::map<Lines, std::set<std::size_t>> files;  // the numbers of those where a text stands
  for (std::size_t file = 0; file < outputs.size(); ++file) {
    for (const std::string& output : outputs[file]) {
      const Lines lines = linesOf(output);
      for (std::size_t i = 0; i < lines.size(); ++i) {
        if (beginsText(lines[i])) files[part(lines, i, endOfText(lines, i))].insert(file);
      }
    }
  }
  std::map<std::string, std::size_t> most;  // by first line: in how many files the most frequent text stands
  Library library;
  for (const auto& [text, where] : files) {
    if (where.size() < 2 || where.size() <= most[text[0]]) continue;
    most[text[0]] = where.size();
    library.texts_[text[0]] = text;
  }
  return library;
}

std::string abbreviated(const std::string& output, const std::string& base, const Library& library) {
  const std::vector<Lines> others = whole(base, {});
  std::vector<Lines> programs;
  std::string text;
  for (const Lines& full : programsOf(output)) {
    const Lines program = withReferences(withoutOwnNumbers(full), library);
    const Lines rest = part(program, 2, program.size());
    Lines shortest = rest;
    const auto tryAll = [&](const std::vector<Lines>& candidates, const std::string& suffix) {
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        Lines lines = difference(rest, part(candidates[i], 2, candidates[i].size()));
        lines.insert(lines.begin(), std::string(mark) + "program " + std::to_string(i + 1) + suffix);
        if (lines.size() < shortest.size()) shortest = std::move(lines);
      }
    };
    tryAll(others, " of glsl330");
    tryAll(programs, "");
    text += textOf(part(program, 0, 2)) + textOf(shortest);
    programs.push_back(program);
  }
  return text;
}

std::string expanded(const std::string& golden, const std::string& base, const Library& library) {
  std::string text;
  for (const Lines& program : whole(golden, whole(base, {}))) {
    text += textOf(withOwnNumbers(withoutReferences(program, library)));
  }
  return text;
}

}  // namespace golden
