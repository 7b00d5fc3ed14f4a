// SPDX-License-Identifier: MIT
//
// Parts of the measured tables of docs/performance.md that README.md shows, so that no figure is copied by hand.
#pragma once

#include <string>

namespace docs {

/// Returns `text` with the table after each mark <!-- excerpt TABLE: ROW, ...; COLUMN, ... --> written anew, up to
/// <!-- /excerpt -->: these rows, by the text of their first cell, and these columns of the table that `source` has
/// after <!-- bench TABLE -->. Throws std::runtime_error where one of them does not exist.
std::string withExcerpts(const std::string& text, const std::string& source);

}  // namespace docs
