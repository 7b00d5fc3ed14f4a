// SPDX-License-Identifier: MIT
#include "sk/mpi_run.hpp"

#include <cstdio>
#include <exception>

#include <fmt/format.h>

#include "messages.hpp"
#include "sk/error.hpp"

namespace sk::mpi {

namespace {

/// Ends all ranks. A main function may print, in the place of the program's own.
[[noreturn]] void abortAll(const char* what) {
  int rank = 0, ranks = 1, length = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  char host[MPI_MAX_PROCESSOR_NAME + 1] = {};
  MPI_Get_processor_name(host, &length);
  const std::string text = fmt::format("rank {} of {} on {}: {}\n", rank, ranks, host, what);
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::terminate();  // MPI_Abort does not return
}

}  // namespace

int run(int argc, char** argv, const std::function<int()>& program) {
  int isThere = 0;
  MPI_Initialized(&isThere);
  if (isThere != 0)
    throw Error("sk::mpi::run: MPI has been initialized before; leave out MPI_Init and MPI_Finalize");
  check(MPI_Init(&argc, &argv), "sk::mpi::run");
  int status = 1;
  try {
    status = program();
  } catch (const std::exception& error) {
    abortAll(error.what());
  } catch (...) {
    abortAll("an exception that is no std::exception");
  }
  MPI_Finalize();
  return status;
}

}  // namespace sk::mpi
