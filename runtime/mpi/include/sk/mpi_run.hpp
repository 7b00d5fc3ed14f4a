// SPDX-License-Identifier: MIT
//
// The main function of a program on many ranks: an exception on one of them ends all.
#pragma once

#include <functional>

namespace sk::mpi {

/// Calls MPI_Init, `program` and MPI_Finalize, and returns what `program` returns. If it throws, the message goes to standard
/// error, with the rank and the host, and MPI_Abort ends all ranks: else these would wait for ever for the one that has
/// left. Throws sk::Error if MPI is initialized already.
int run(int argc, char** argv, const std::function<int()>& program);

}  // namespace sk::mpi
