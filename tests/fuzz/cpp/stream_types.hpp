// SPDX-License-Identifier: MIT
//
// Gathers, bundles and the other parameters that only kernels have: what they are chosen among, how .sk declares them, and how the
// oracle gives them values (streams_as_cpp.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cpp/unit.hpp"

namespace fuzz::cpp {

/// What gathers of this program hold; few types, so that functions find the gathers that they want.
struct StreamTypes {
  std::vector<TypeId> elements;
  std::vector<TypeId> bundles;  ///< of those that are templates, the one of anyRank
};

/// Adds an element type of gathers, if there is one among some random types.
void addElement(Unit& unit, StreamTypes& streams);
/// A gather or a bundle; of anyRank, if that is asked for, or an index.
TypeId pickStream(Unit& unit, const StreamTypes& streams, bool isOfAnyRank);

/// A parameter of a kernel, or a member of a bundle: its type and boundary mode, or `spec`. Empty if there is no such one now.
enum class Member : std::uint8_t { Gather, Uniform, Spec, Bundle };
std::optional<Field> pickMember(Unit& unit, const StreamTypes& streams, Member kind, bool isOfAnyRank);
/// Chooses a boundary mode.
void pickMode(Unit& unit, Field& field);
/// "[[wrap]] float u[][]", "spec int n" or "gather<float, N> u".
std::string declared(Unit& unit, const Field& field, bool mayHaveBrackets);
/// The lines that give a parameter of a kernel its values in C++.
std::string bindings(const Types& types, const Field& parameter);

}  // namespace fuzz::cpp
