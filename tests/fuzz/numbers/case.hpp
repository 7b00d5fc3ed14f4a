// SPDX-License-Identifier: MIT
//
// One call of a kernel, a reduce or a scan with all that it is given, and its text, which reproduces it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sk/options.hpp"
#include "sk/shape.hpp"

namespace fuzz::numbers {

/// The types of elements.
enum class Element : std::uint8_t { Float, Float3, Double, Int, Uint };
int components(Element element);

/// Where the elements of a call's streams lie.
enum class View : std::uint8_t { Whole, Box, Strided, Reshaped };

/// The components of elements, one after the other; doubles hold every number of every Element.
using Values = std::vector<double>;

struct Case {
  std::string operation;
  sk::CallOptions options;
  View view = View::Whole;
  int textureLimit = 0;  ///< of GL devices; 0 for their own
  bool isPairs = false;  ///< GL devices compute doubles as pairs of floats
  sk::Storage storage = sk::Storage::Single;  ///< of inputs of floats
  std::vector<std::int64_t> shape;  ///< of the elements
  std::vector<std::int64_t> result;  ///< of a reduce and a folded output; empty: folds to a value
  std::vector<std::int64_t> starts;  ///< of rows; empty: there are none
  std::vector<Values> inputs;  ///< streams, tables and uniforms, in the order of the parameters
};

sk::Shape shapeOf(const std::vector<std::int64_t>& extents);

/// As JSON, with numbers in hexadecimal; and back. parsed() throws std::runtime_error for what is no case.
std::string written(const Case& one);
Case parsed(const std::string& text);

/// The options of a case as runtime/web takes them, as JSON.
std::string optionsInBrowsers(const Case& one);

/// What a reader wants to know of a case, on one line, without its data.
std::string described(const Case& one);
/// A number in decimal and, unless it is a small integer, in hexadecimal.
std::string shown(double x);

}  // namespace fuzz::numbers
