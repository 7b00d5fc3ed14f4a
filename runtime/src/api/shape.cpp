// SPDX-License-Identifier: MIT
//
// Error messages and text of shapes.
#include "sk/shape.hpp"

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk {

namespace {

template <class Extents>
std::string inBraces(const Extents& extents) {
  std::string text = "{";
  for (int d = 0; d < extents.rank(); ++d) {
    text += d == 0 ? "" : ", ";
    text += std::to_string(extents[d]);
  }
  return text + "}";
}

}  // namespace

std::string toString(const Shape& shape) { return inBraces(shape); }
std::string toString(const Index& index) { return inBraces(index); }

void Shape::throwInvalid(const char* why) const {
  throw Error(fmt::format("{} is not a shape: {}", toString(*this), why), Error::Kind::Shape);
}

void detail::throwExtentTooLarge() {
  throw Error("an extent or position does not fit in 63 bits", Error::Kind::Shape);
}

}  // namespace sk
