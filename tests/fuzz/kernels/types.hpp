// SPDX-License-Identifier: MIT
//
// The types of random kernels: their spellings, their sizes, and how they quantize values.
#pragma once

#include <span>
#include <string>

#include "kernels/model.hpp"
#include "random.hpp"

namespace fuzz {

using Records = std::vector<Record>;

bool isNarrow(Scalar scalar);
bool isNormalized(Scalar scalar);
/// The arithmetic type of a storage type; other types themselves.
Scalar arithmeticScalar(Scalar scalar);
/// The integer that stands for 1: 255, 127, 65535 or 32767.
float scaleOf(Scalar normalized);

int componentsOf(const Records& records, const Type& type);
std::string spelling(const Records& records, const Type& type);

/// The scalar of each component.
std::vector<Scalar> scalarsOf(const Records& records, const Type& type);

/// `value`, rounded to what a variable of the type can hold.
Value quantized(const Records& records, const Type& type, Value value);

/// A random value of the type; floats are within the bound `kept`.
Value randomValue(const Records& records, const Type& type, Random& random);

/// A scalar, vector, matrix or struct that streams may hold.
Type randomType(const Records& records, Random& random);
/// A scalar or a vector, of an arithmetic or a storage type.
Type randomVector(Random& random);

/// A literal with the components of `value`, of an arithmetic type or a vector of one.
std::string literal(const Type& type, const Value& value);

}  // namespace fuzz
