// SPDX-License-Identifier: MIT
#include "refusal.hpp"

#include <exception>
#include <new>

#include <fmt/format.h>

#include "support/checked_size.hpp"

namespace sk::mpi {

Error currentError(std::string_view what) noexcept {
  static const Error unknown("an exception that is no std::exception", Error::Kind::Misuse);
  try {
    try {
      throw;
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc& error) {
      failForHostMemory(what, error);
    } catch (const std::exception& error) {
      throw Error(fmt::format("{}: {}", what, error.what()));
    }
  } catch (const Error& error) {
    return error;  // a copy allocates nothing
  } catch (...) {
    return unknown;
  }
}

}  // namespace sk::mpi
