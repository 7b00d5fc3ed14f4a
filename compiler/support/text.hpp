// SPDX-License-Identifier: MIT
//
// Text utilities that all printers share.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace skc {

/// The shortest decimal text that reads back as the same float, with a point or an exponent:
/// "0.1", "1.0", "1e+30", "-0.0". `value` is finite.
std::string shortestFloat(float value);

/// The same for a double. Values that are not finite give "inf", "-inf" and "nan".
std::string shortestDouble(double value);

/// Concatenates the items with `separator` between them.
std::string join(std::span<const std::string> items, std::string_view separator);

/// Breaks a long line of C-like text into lines of at most `limit` columns where possible: after commas and
/// binary operators, preferring the fewest open brackets and the lowest precedence. Continuation lines begin
/// in column `continuation`; 0 means four more than the line itself. String literals are not broken.
std::string wrapLine(std::string_view line, std::size_t limit = 100, std::size_t continuation = 0);

/// A hash that is the same everywhere: 64-bit FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo, "The FNV Non-Cryptographic Hash Algorithm",
/// IETF draft).
std::uint64_t textHash(std::string_view text);

}  // namespace skc
