// SPDX-License-Identifier: MIT
//
// Solves equations with an installed StreamKernel. Prints the outcome, an element of x, and what is said of a right-hand side of the wrong size.
#include <sk/linear.hpp>

#include <cstdio>

sk::linear::SparseMatrix chain(std::int64_t n);

int main() try {
  sk::Device device;
  const sk::linear::SparseMatrix a = chain(100);
  sk::linear::Solver solver(device, a, {.preconditioner = "ic0", .tolerance = 1e-10});
  const sk::linear::Solution s = solver.solve(sk::linear::multiply(a, std::vector<double>(100, 3.0)));
  std::printf("%s %.6f ", std::string(sk::linear::nameOf(s.outcome)).c_str(), s.x[50]);
  try {
    solver.solve(std::vector<double>(7));
  } catch (const sk::Error& error) {
    std::printf("%s", error.what());
  }
} catch (const sk::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
