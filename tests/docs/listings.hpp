// SPDX-License-Identifier: MIT
//
// The .sk blocks of the documents as files, and what skc makes of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "markdown.hpp"

namespace docs {

/// A block as a whole file: `sk body` is put into a kernel, whose parameters are those that
/// tests/docs/README.md lists.
std::string wholeFile(const Block& block);

/// The name of a block's file: that of `file=`, or one made of its place ("language.md.120.sk").
std::string fileName(const Block& block);

/// Writes the named blocks (`file=`) to `folder`; a name may be given twice only to the same text.
void writeNamedFiles(const std::filesystem::path& folder);

/// Whether `text` holds the lines of `excerpt` in order, without a gap; a line of the excerpt that is
/// "..." allows one. Spaces at the ends of lines, and empty lines, do not count.
bool quotes(const std::string& excerpt, const std::string& text);

}  // namespace docs
