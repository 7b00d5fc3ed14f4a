// SPDX-License-Identifier: MIT
//
// Counts what the tests' ranks create and free, by MPI's profiling interface: requests, communicators and files. A program that
// ends with any of them left fails. Debian's builds of Open MPI and MPICH do not report them. Also counts messages that reduce.
#include <atomic>
#include <cstdio>

#include <mpi.h>

#include "ranks.hpp"

namespace {

std::atomic<int> requests{0}, communicators{0}, files{0};
std::atomic<long> reducedMessages{0}, reducedBytes{0};

int created(std::atomic<int>& kind, int status) {
  if (status == MPI_SUCCESS) ++kind;
  return status;
}

/// Counts a request that a call has completed.
int completed(MPI_Request before, const MPI_Request* after, int status) {
  if (before != MPI_REQUEST_NULL && *after == MPI_REQUEST_NULL) --requests;
  return status;
}

}  // namespace

Reduced reducedSoFar() { return {reducedMessages, reducedBytes}; }

extern "C" {

int MPI_Isend(const void* bytes, int count, MPI_Datatype type, int to, int tag, MPI_Comm all,
              MPI_Request* request) {
  return created(requests, PMPI_Isend(bytes, count, type, to, tag, all, request));
}
int MPI_Irecv(void* bytes, int count, MPI_Datatype type, int from, int tag, MPI_Comm all,
              MPI_Request* request) {
  return created(requests, PMPI_Irecv(bytes, count, type, from, tag, all, request));
}
int MPI_Iallreduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op op, MPI_Comm all,
                   MPI_Request* request) {
  int size = 0;
  MPI_Type_size(type, &size);
  ++reducedMessages;
  reducedBytes += static_cast<long>(count) * size;
  return created(requests, PMPI_Iallreduce(from, to, count, type, op, all, request));
}
int MPI_Iallgatherv(const void* from, int count, MPI_Datatype type, void* to, const int* counts,
                    const int* offsets, MPI_Datatype toType, MPI_Comm all, MPI_Request* request) {
  return created(requests, PMPI_Iallgatherv(from, count, type, to, counts, offsets, toType, all, request));
}
int MPI_Wait(MPI_Request* request, MPI_Status* status) {
  const MPI_Request before = *request;
  return completed(before, request, PMPI_Wait(request, status));
}
int MPI_Test(MPI_Request* request, int* isDone, MPI_Status* status) {
  const MPI_Request before = *request;
  return completed(before, request, PMPI_Test(request, isDone, status));
}
int MPI_Waitall(int count, MPI_Request* all, MPI_Status* statuses) {
  int pending = 0;
  for (int i = 0; i < count; ++i) pending += all[i] != MPI_REQUEST_NULL ? 1 : 0;
  const int status = PMPI_Waitall(count, all, statuses);
  for (int i = 0; i < count; ++i) pending -= all[i] != MPI_REQUEST_NULL ? 1 : 0;
  requests -= pending;
  return status;
}
int MPI_Testall(int count, MPI_Request* all, int* areDone, MPI_Status* statuses) {
  int pending = 0;
  for (int i = 0; i < count; ++i) pending += all[i] != MPI_REQUEST_NULL ? 1 : 0;
  const int status = PMPI_Testall(count, all, areDone, statuses);
  if (*areDone != 0) requests -= pending;
  return status;
}
int MPI_Comm_dup(MPI_Comm from, MPI_Comm* copy) { return created(communicators, PMPI_Comm_dup(from, copy)); }
int MPI_Comm_split(MPI_Comm from, int color, int key, MPI_Comm* part) {
  const int status = PMPI_Comm_split(from, color, key, part);
  return *part == MPI_COMM_NULL ? status
                                : created(communicators, status);  // null where this rank has no part
}
int MPI_Comm_split_type(MPI_Comm from, int type, int key, MPI_Info info, MPI_Comm* part) {
  return created(communicators, PMPI_Comm_split_type(from, type, key, info, part));
}
int MPI_Comm_free(MPI_Comm* all) {
  --communicators;
  return PMPI_Comm_free(all);
}
int MPI_File_open(MPI_Comm all, const char* name, int mode, MPI_Info info, MPI_File* file) {
  return created(files, PMPI_File_open(all, name, mode, info, file));
}
int MPI_File_close(MPI_File* file) {
  --files;
  return PMPI_File_close(file);
}

int MPI_Finalize() {
  if (requests != 0 || communicators != 0 || files != 0) {
    std::fprintf(stderr, "left at the end: %d request(s), %d communicator(s), %d file(s)\n", requests.load(),
                 communicators.load(), files.load());
    PMPI_Abort(MPI_COMM_WORLD, 1);
  }
  return PMPI_Finalize();
}

}  // extern "C"
