// SPDX-License-Identifier: MIT
//
// What each choice of precision, storage and accumulation is worth for a system of equations: the residual that it attains, its
// iterations and its time.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "method.hpp"
#include "preconditioner.hpp"
#include "solve.hpp"
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

/// A study of systems of its own, whose table docs/linear.md shows.
struct StudyKind {
  std::string_view name;  ///< of --study
  std::string_view does;
  /// A table in Markdown.
  std::string (*run)(sk::Device& device);
};

std::span<const StudyKind> studyKinds();

}  // namespace linear
