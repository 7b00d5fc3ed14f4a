// SPDX-License-Identifier: MIT
//
// Lines, words and numbers of text files, as sk::linear reads them.
#pragma once

#include "text/text_cursor.hpp"

namespace examples {

using sk::text::lineEndAt;
using sk::text::numberIn;
using sk::text::TextCursor;
using sk::text::TextRules;
using sk::text::trimmed;
using sk::text::withoutMark;

}  // namespace examples
