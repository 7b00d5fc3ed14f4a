// SPDX-License-Identifier: MIT
//
// The header of .npy files (NumPy Enhancement Proposal 1): the type and the extents of an array, as text. It opens no file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk::npy {

/// An array as a header describes it.
struct NpyArray {
  std::string type;  ///< as NumPy spells it, without spaces: "'<f4'" or "[('t','<f4'),('id','<i4')]"
  std::vector<std::int64_t> extents;
};

/// The array that holds elements of a stream of this shape, as they are in host memory, or as doubles in place of floats.
/// Components of a vector or a matrix are further dimensions; structs are structured types. Throws sk::Error if a struct
/// would have doubles.
NpyArray npyArray(const program::Element& element, const Shape& shape, bool asDoubles);

/// The bytes of an element of the array.
std::size_t elementBytes(const program::Element& element, bool asDoubles);

/// The header, with all that stands before the elements.
std::string npyHeader(const NpyArray& array);

/// The bytes in front of the header's text that say how long it is.
inline constexpr std::size_t npyPrefix = 12;
/// The length of the whole header, from a file's first npyPrefix bytes; 0 if these do not begin a .npy file.
std::size_t npyHeaderLength(std::string_view prefix);

/// Parses a whole header. Returns "" or what is wrong with it.
std::string parseNpyHeader(std::string_view header, NpyArray& array);

/// "(512, 512)", as NumPy writes it.
std::string npyShape(const std::vector<std::int64_t>& extents);

}  // namespace sk::npy
