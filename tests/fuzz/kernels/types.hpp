// SPDX-License-Identifier: MIT
//
// The types of random kernels: their spellings, their sizes, what they make of a value that is kept in them.
#pragma once

#include <span>
#include <string>

#include "kernels/model.hpp"
#include "random.hpp"

namespace fuzz {

using Records = std::vector<Record>;

bool isNarrow(Scalar scalar);
bool isNormalized(Scalar scalar);
/// What a narrow type is computed in; of others themselves.
Scalar carrierOf(Scalar scalar);
/// 255, 127, 65535 or 32767.
float scaleOf(Scalar normalized);

int componentsOf(const Records& records, const Type& type);
std::string spelling(const Records& records, const Type& type);

/// The scalar of each component.
std::vector<Scalar> scalarsOf(const Records& records, const Type& type);

/// `value` as a variable of the type holds it.
Value quantized(const Records& records, const Type& type, Value value);

/// A random value that a stream or a uniform of the type may hold; floats are within `kept`.
Value randomValue(const Records& records, const Type& type, Random& random);

/// A scalar, vector, matrix or struct that streams may hold.
Type randomType(const Records& records, Random& random);
/// A scalar or a vector, narrow ones among them.
Type randomVector(Random& random);

/// A literal of the components of `value`, of a carrier type or a vector of one.
std::string literal(const Type& type, const Value& value);

}  // namespace fuzz
