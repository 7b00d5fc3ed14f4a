// SPDX-License-Identifier: MIT
//
// The numbers that all contenders of a program share. C++17, since peers include it.
#pragma once

namespace race {

constexpr float saxpyFactor = 2.5f;

/// The five-point stencil is a step of the heat equation: v = u + heatFlow (sum of the neighbours - 4 u).
constexpr float heatFlow = 0.2f;

// The window of the Mandelbrot set is square, whatever the picture is, and most steps are taken.
constexpr float mandelbrotLeft = -2.0f;
constexpr float mandelbrotTop = -1.25f;
constexpr float mandelbrotExtent = 2.5f;
constexpr int mandelbrotSteps = 256;

/// Squared, of bodies that attract each other.
constexpr float softening = 1e-3f;

// Gray and Scott's reaction.
constexpr int reactionSteps = 10;
constexpr float reactionFeed = 0.04f;
constexpr float reactionKill = 0.06f;
constexpr float reactionSpreadU = 0.16f;
constexpr float reactionSpreadV = 0.08f;

// A step of the boiling lattice: temperatures, and how strongly things happen.
constexpr float boilingPoint = 10, boilingBottom = 10.5f, boilingTop = 9.5f;
constexpr float boilingSpread = 0.125f, boilingAlpha = 10, boilingSigma = 0.05f, boilingLatent = 0.1f;

// One of the convecting lattice.
constexpr float flowCarry = 0.05f, flowViscosity = 0.1f, flowLift = 0.02f, flowRest = 1;
constexpr float flowSpread = 0.12f, flowStiffness = 0.2f;

/// Entries in a row of the sparse matrix, on average.
constexpr int sparseRow = 16;

}  // namespace race
