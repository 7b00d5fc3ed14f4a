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

/// Steps of a run of the programs that repeat a step.
constexpr int loopSteps = 100;
/// The coefficient of the wave equation, (speed * time step / spacing)^2. The scheme is stable up to 1/2.
constexpr float waveStiffness = 0.2f;

// A step of the boiling lattice: temperatures, and how strongly things happen.
constexpr float boilingPoint = 10, boilingBottom = 10.5f, boilingTop = 9.5f;
constexpr float boilingSpread = 0.125f, boilingAlpha = 10, boilingSigma = 0.05f, boilingLatent = 0.1f;

// One of the convecting lattice.
constexpr float flowCarry = 0.05f, flowViscosity = 0.1f, flowDamping = 0.05f, flowLift = 0.02f, flowRest = 1;
constexpr float flowSpread = 0.12f, flowStiffness = 0.2f;

// A step of the cloth: cells of a length, falling by a length, links that lose a part of their excess, and the ball.
constexpr float clothCell = 0.01f, clothDiagonal = 0.014142136f, clothHeight = 0.3f, clothThickness = 0.005f;
constexpr float clothFall = -1e-5f, clothKeep = 0.999f;
constexpr float clothStructural = 0.2f, clothShear = 0.12f, clothBend = 0.03f;
constexpr int clothRounds = 2;
constexpr float clothBall[4] = {0.1f, 0.1f, 0.05f, 0.2f};  // centre and radius

struct ClothLink {
  int x, y;
  float rest, factor;
};
constexpr ClothLink clothLinks[12] = {
    {1, 0, clothCell, clothStructural}, {-1, 0, clothCell, clothStructural},
    {0, 1, clothCell, clothStructural}, {0, -1, clothCell, clothStructural},
    {1, 1, clothDiagonal, clothShear},  {-1, -1, clothDiagonal, clothShear},
    {-1, 1, clothDiagonal, clothShear}, {1, -1, clothDiagonal, clothShear},
    {2, 0, 2 * clothCell, clothBend},   {-2, 0, 2 * clothCell, clothBend},
    {0, 2, 2 * clothCell, clothBend},   {0, -2, 2 * clothCell, clothBend},
};

/// A step of conjugate gradients: rn = r - residualStep q.
constexpr float residualStep = 0.75f;

/// Entries in a row of the sparse matrix, on average.
constexpr int sparseRow = 16;
/// The same of the matrix whose rows have lengths by a power law: the share of rows with k entries or more falls as 1 / k^1.2, from 4 entries on.
constexpr int powerLawRow = 20;

/// Iterations of conjugate gradients in one run, for grids of this number of elements.
constexpr int gradientSteps(double elements) { return elements > 1 << 20 ? 16 : 128; }

}  // namespace race
