// SPDX-License-Identifier: MIT
//
// What tests on ranks share. Collective calls need all ranks, so that a test case that fails on one rank ends all of them.
#pragma once

#include <string>
#include <vector>

#include <mpi.h>

int rankOfWorld();
int ranksOfWorld();

/// What this rank has given to MPI_Iallreduce.
struct Reduced {
  long messages, bytes;
  bool operator==(const Reduced&) const = default;
};
Reduced reducedSoFar();

/// The elements of rank 0, on every rank.
template <class T>
std::vector<T> everywhere(std::vector<T> elements) {
  unsigned long long size = elements.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
  elements.resize(size);
  MPI_Bcast(elements.data(), static_cast<int>(size * sizeof(T)), MPI_BYTE, 0, MPI_COMM_WORLD);
  return elements;
}
