// SPDX-License-Identifier: MIT
//
// What each choice of precision, storage and accumulation is worth for a system of equations: the residual that it attains, its
// iterations and its time.
#pragma once

#include <span>
#include <string>

#include "method.hpp"
#include "preconditioner.hpp"
#include "solve.hpp"
#include "support/study.hpp"
#include "system.hpp"

namespace linear {

struct StudyChoices {
  const MethodKind& method;
  const PreconditionerKind& preconditioner;
  std::string layout;
  SolveSettings settings;
};

/// Solves the system with every choice, once without and once with refinement. Returns a table in Markdown, and a line that names
/// the cheapest choice within the tolerance. Choices that the device does not have are left out.
std::string studyPrecisions(sk::Device& device, const System& system, const StudyChoices& choices);

/// Studies of systems of their own, whose tables docs/linear.md shows.
std::span<const examples::Study> studyKinds();

}  // namespace linear
