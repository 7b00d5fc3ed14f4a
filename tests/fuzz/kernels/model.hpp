// SPDX-License-Identifier: MIT
//
// The parts of random kernels. Every expression and statement has both a text, which goes to skc, and a meaning, which runs
// here, element by element.
//
// Floats are chosen such that nothing is ever rounded. Each expression has a bound: its values are k / 2^fraction with
// |k| <= 2^(magnitude + fraction). As long as that is at most 2^24, every order of evaluation and every contraction gives
// the same value. Values that variables hold are reduced to the bound `kept` (expressions.hpp, tamed).
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sk/program.hpp"

namespace fuzz {

using Scalar = sk::program::Scalar;

struct Type {
  Scalar scalar = Scalar::Float;
  int width = 1;  ///< components, or rows and columns of a matrix
  bool isMatrix = false;
  int record = -1;  ///< index of a struct, which replaces all of the above

  friend bool operator==(const Type&, const Type&) = default;
};

/// Up to 16 components, one after the other: of vectors, rows of matrices, members of structs. Components of a storage type
/// are in their arithmetic type, int or float.
struct Value {
  std::array<std::uint32_t, 16> bits{};

  float asFloat(int i) const { return std::bit_cast<float>(bits[static_cast<std::size_t>(i)]); }
  std::int32_t asInt(int i) const { return static_cast<std::int32_t>(bits[static_cast<std::size_t>(i)]); }
  std::uint32_t asUint(int i) const { return bits[static_cast<std::size_t>(i)]; }
  void set(int i, float value) { bits[static_cast<std::size_t>(i)] = std::bit_cast<std::uint32_t>(value); }
  void set(int i, std::uint32_t value) { bits[static_cast<std::size_t>(i)] = value; }
};

struct Record {
  struct Member {
    std::string name;
    Type type;
  };
  std::string name;
  std::vector<Member> members;
};

/// A stream's elements on the host, row-major, rows first.
struct HostStream {
  Type type;
  std::vector<std::int64_t> shape;
  std::vector<Value> elements;
};

/// The state of a kernel while it runs for one element. Every variable of every function has its own slot: there is no
/// recursion.
struct Frame {
  std::vector<Value> slots;
  std::array<int, 4> index{}, extent{1, 1, 1, 1};  ///< index in the domain and extents of the domain, x first
  const std::vector<HostStream>* streams = nullptr;  ///< one per parameter
  std::vector<HostStream>* appendOutputs =
      nullptr;  ///< one per parameter: what has been pushed and scattered so far
};

struct Bound {
  int magnitude = 0, fraction = 0;
  int bits() const { return magnitude + fraction; }
};
inline constexpr Bound kept{6, 4};
inline constexpr int exactBits = 24;

struct Expr {
  Type type;
  std::string text;  ///< in parentheses unless it is a primary expression
  std::function<Value(Frame&)> value;
  Bound bound = {};  ///< for floats only
};

/// The location of a place: components of a slot.
struct Where {
  int slot = 0;
  std::array<std::uint8_t, 16> components{};
};

/// A part of a variable, which can be read and, if isWritable, written.
struct Place {
  Type type;
  std::string text;
  std::function<Where(Frame&)> where;
  bool isWritable = false;
};

enum class Flow : std::uint8_t { Next, Break, Continue, Return };

struct Statement {
  std::string text;  ///< whole lines
  std::function<Flow(Frame&)> run;
};

}  // namespace fuzz
