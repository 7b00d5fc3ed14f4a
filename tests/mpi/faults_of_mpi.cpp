// SPDX-License-Identifier: MIT
//
// The functions that replace those of MPI. What only this rank does is not done where it fails; what all ranks do together is done,
// because they would wait, and then fails.
#include "faults_of_mpi.hpp"

#include <cerrno>

#include <mpi.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "faults.hpp"

namespace faults {

namespace {

thread_local bool isArmed = false, hasFiredNow = false;
thread_local long armedNumber = 0, seen = 0;
thread_local int inMpi = 0;
Handles living;

bool fails() {
  if (!isArmed || inMpi > 0 || ++seen != armedNumber) return false;
  hasFiredNow = true;
  return true;
}

/// MPI's own allocations do not fail.
template <class Call>
int inside(Call&& call) {
  const InDriver scope;
  ++inMpi;
  const int status = call();
  --inMpi;
  return status;
}

/// A function that only this rank carries out.
template <class Call>
int alone(Call&& call) {
  return fails() ? MPI_ERR_NO_MEM : inside(call);
}

/// A function that the ranks carry out together.
template <class Call>
int together(Call&& call) {
  const int status = inside(call);
  return fails() ? MPI_ERR_OTHER : status;
}

/// Counts a handle that has been created.
int created(int& kind, bool isThere, int status) {
  if (isThere) ++kind;
  return status;
}

}  // namespace

MpiFault::MpiFault(long number) {
  armedNumber = number;
  seen = 0;
  hasFiredNow = false;
  isArmed = true;
}
MpiFault::~MpiFault() { isArmed = false; }
bool MpiFault::hasFired() { return hasFiredNow; }
Handles handles() { return living; }

}  // namespace faults

using faults::alone;
using faults::created;
using faults::inside;
using faults::living;
using faults::together;

extern "C" {

int MPI_Isend(const void* bytes, int count, MPI_Datatype type, int to, int tag, MPI_Comm all,
              MPI_Request* request) {
  const int status = alone([&] { return PMPI_Isend(bytes, count, type, to, tag, all, request); });
  return created(living.requests, status == MPI_SUCCESS, status);
}
int MPI_Irecv(void* bytes, int count, MPI_Datatype type, int from, int tag, MPI_Comm all,
              MPI_Request* request) {
  const int status = alone([&] { return PMPI_Irecv(bytes, count, type, from, tag, all, request); });
  return created(living.requests, status == MPI_SUCCESS, status);
}
int MPI_Iallreduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op op, MPI_Comm all,
                   MPI_Request* request) {
  const int status = inside([&] { return PMPI_Iallreduce(from, to, count, type, op, all, request); });
  return created(living.requests, status == MPI_SUCCESS, status);
}
int MPI_Iallgatherv(const void* from, int count, MPI_Datatype type, void* to, const int* counts,
                    const int* offsets, MPI_Datatype toType, MPI_Comm all, MPI_Request* request) {
  const int status =
      inside([&] { return PMPI_Iallgatherv(from, count, type, to, counts, offsets, toType, all, request); });
  return created(living.requests, status == MPI_SUCCESS, status);
}
int MPI_Wait(MPI_Request* request, MPI_Status* status) {
  const bool isPending = *request != MPI_REQUEST_NULL;
  const int result = inside([&] { return PMPI_Wait(request, status); });
  if (isPending && *request == MPI_REQUEST_NULL) --living.requests;
  return result;
}
int MPI_Test(MPI_Request* request, int* isDone, MPI_Status* status) {
  const bool isPending = *request != MPI_REQUEST_NULL;
  const int result = inside([&] { return PMPI_Test(request, isDone, status); });
  if (isPending && *request == MPI_REQUEST_NULL) --living.requests;
  return result;
}
int MPI_Waitall(int count, MPI_Request* all, MPI_Status* statuses) {
  int pending = 0;
  for (int i = 0; i < count; ++i) pending += all[i] != MPI_REQUEST_NULL ? 1 : 0;
  const auto wait = [&] { return PMPI_Waitall(count, all, statuses); };
  // The runtime waits for a single request when it compares the ranks; that must not fail.
  const int result = count > 1 ? together(wait) : inside(wait);
  for (int i = 0; i < count; ++i) pending -= all[i] != MPI_REQUEST_NULL ? 1 : 0;
  living.requests -= pending;
  return result;
}
int MPI_Testall(int count, MPI_Request* all, int* areDone, MPI_Status* statuses) {
  int pending = 0;
  for (int i = 0; i < count; ++i) pending += all[i] != MPI_REQUEST_NULL ? 1 : 0;
  const int status = inside([&] { return PMPI_Testall(count, all, areDone, statuses); });
  if (*areDone != 0) living.requests -= pending;
  return status;
}
int MPI_Allgather(const void* from, int count, MPI_Datatype type, void* to, int toCount, MPI_Datatype toType,
                  MPI_Comm all) {
  return together([&] { return PMPI_Allgather(from, count, type, to, toCount, toType, all); });
}
int MPI_Allgatherv(const void* from, int count, MPI_Datatype type, void* to, const int* counts,
                   const int* offsets, MPI_Datatype toType, MPI_Comm all) {
  return together([&] { return PMPI_Allgatherv(from, count, type, to, counts, offsets, toType, all); });
}
int MPI_Bcast(void* bytes, int count, MPI_Datatype type, int root, MPI_Comm all) {
  return together([&] { return PMPI_Bcast(bytes, count, type, root, all); });
}
int MPI_Comm_dup(MPI_Comm from, MPI_Comm* copy) {
  const int status = inside([&] { return PMPI_Comm_dup(from, copy); });
  return created(living.communicators, status == MPI_SUCCESS, status);
}
int MPI_Comm_split(MPI_Comm from, int color, int key, MPI_Comm* part) {
  const int status = together([&] { return PMPI_Comm_split(from, color, key, part); });
  return created(living.communicators, *part != MPI_COMM_NULL, status);
}
int MPI_Comm_split_type(MPI_Comm from, int type, int key, MPI_Info info, MPI_Comm* part) {
  const int status = together([&] { return PMPI_Comm_split_type(from, type, key, info, part); });
  return created(living.communicators, *part != MPI_COMM_NULL, status);
}
int MPI_Comm_free(MPI_Comm* all) {
  --living.communicators;
  return PMPI_Comm_free(all);
}
int MPI_Type_contiguous(int count, MPI_Datatype of, MPI_Datatype* type) {
  const int status = alone([&] { return PMPI_Type_contiguous(count, of, type); });
  return created(living.types, status == MPI_SUCCESS, status);
}
int MPI_Type_create_subarray(int rank, const int* extents, const int* part, const int* begin, int order,
                             MPI_Datatype of, MPI_Datatype* type) {
  const int status =
      alone([&] { return PMPI_Type_create_subarray(rank, extents, part, begin, order, of, type); });
  return created(living.types, status == MPI_SUCCESS, status);
}
int MPI_Type_commit(MPI_Datatype* type) {
  return alone([&] { return PMPI_Type_commit(type); });
}
int MPI_Type_free(MPI_Datatype* type) {
  --living.types;
  return PMPI_Type_free(type);
}
int MPI_File_open(MPI_Comm all, const char* name, int mode, MPI_Info info, MPI_File* file) {
  const int status = together([&] { return PMPI_File_open(all, name, mode, info, file); });
  return created(living.files, *file != MPI_FILE_NULL, status);
}
int MPI_File_set_size(MPI_File file, MPI_Offset size) {
  return together([&] { return PMPI_File_set_size(file, size); });
}
int MPI_File_write_at(MPI_File file, MPI_Offset at, const void* bytes, int count, MPI_Datatype type,
                      MPI_Status* status) {
  return alone([&] { return PMPI_File_write_at(file, at, bytes, count, type, status); });
}
int MPI_File_set_view(MPI_File file, MPI_Offset at, MPI_Datatype element, MPI_Datatype part, const char* name,
                      MPI_Info info) {
  return together([&] { return PMPI_File_set_view(file, at, element, part, name, info); });
}
int MPI_File_write_all(MPI_File file, const void* bytes, int count, MPI_Datatype type, MPI_Status* status) {
  return together([&] { return PMPI_File_write_all(file, bytes, count, type, status); });
}
int MPI_File_read_all(MPI_File file, void* bytes, int count, MPI_Datatype type, MPI_Status* status) {
  return together([&] { return PMPI_File_read_all(file, bytes, count, type, status); });
}
int MPI_File_close(MPI_File* file) {
  --living.files;
  return together([&] { return PMPI_File_close(file); });
}
/// Each rank brings files to the disk by itself.
int fsync(int file) {
  if (!faults::fails()) return static_cast<int>(::syscall(SYS_fsync, file));
  errno = EIO;
  return -1;
}

}  // extern "C"
