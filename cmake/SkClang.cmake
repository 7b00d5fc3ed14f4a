# SPDX-License-Identifier: MIT
#
# Clang 19 and LLVM 19 as targets: their headers (as SYSTEM) and their shared libraries. Only
# compiler/frontend links sk_clang, and only compiler/native sk_llvm. SK_LLVM_ROOT names another installation.
#
# Clang's own CMake package is not used: Debian ships it with the compiler, not with the headers, and
# it looks for a dozen libraries (curl, libedit, z3 ...) that matter only to LLVM's static archives.
include_guard(GLOBAL)

set(SK_LLVM_VERSION 19)
set(SK_LLVM_ROOT "" CACHE PATH "Prefix of an LLVM ${SK_LLVM_VERSION} with Clang, if not where distributions put it")

# sk_clang_missing(WHAT PACKAGE): stops, naming what to install.
function(sk_clang_missing what package)
  message(FATAL_ERROR
    "StreamKernel: ${what} of version ${SK_LLVM_VERSION} not found; skc is built on it.\n"
    "  On Debian: apt-get install ${package}\n"
    "  Elsewhere: -DSK_LLVM_ROOT=<prefix of LLVM ${SK_LLVM_VERSION}>\n"
    "  Without it: -DSK_BUILD_COMPILER=OFF uses an installed skc (PATH, or -DSK_SKC=<file>).")
endfunction()

set(places ${SK_LLVM_ROOT} /usr/lib/llvm-${SK_LLVM_VERSION} /usr/lib64/llvm${SK_LLVM_VERSION}
    /usr/lib/llvm${SK_LLVM_VERSION} /opt/homebrew/opt/llvm@${SK_LLVM_VERSION})
find_path(SK_CLANG_INCLUDE_DIR clang/AST/Decl.h HINTS ${places} PATH_SUFFIXES include)
find_path(SK_LLVM_INCLUDE_DIR llvm/Config/llvm-config.h HINTS ${places} PATH_SUFFIXES include)
find_library(SK_CLANG_LIBRARY NAMES clang-cpp libclang-cpp.so.${SK_LLVM_VERSION}.1
             HINTS ${places} PATH_SUFFIXES lib)
find_library(SK_LLVM_LIBRARY NAMES LLVM-${SK_LLVM_VERSION} libLLVM.so.${SK_LLVM_VERSION}.1
             HINTS ${places} PATH_SUFFIXES lib)
mark_as_advanced(SK_CLANG_INCLUDE_DIR SK_LLVM_INCLUDE_DIR SK_CLANG_LIBRARY SK_LLVM_LIBRARY)

if(NOT SK_CLANG_INCLUDE_DIR)
  sk_clang_missing("Clang's headers" libclang-${SK_LLVM_VERSION}-dev)
elseif(NOT SK_LLVM_INCLUDE_DIR OR NOT SK_LLVM_LIBRARY)
  sk_clang_missing("LLVM" llvm-${SK_LLVM_VERSION}-dev)
elseif(NOT SK_CLANG_LIBRARY)
  sk_clang_missing("Clang's shared library" libclang-cpp${SK_LLVM_VERSION})
endif()

file(STRINGS "${SK_LLVM_INCLUDE_DIR}/llvm/Config/llvm-config.h" version REGEX "define LLVM_VERSION_STRING ")
string(REGEX REPLACE ".*\"(.*)\".*" "\\1" version "${version}")
if(NOT version MATCHES "^${SK_LLVM_VERSION}\\.")
  sk_clang_missing("LLVM (found only ${version} in ${SK_LLVM_INCLUDE_DIR})" llvm-${SK_LLVM_VERSION}-dev)
endif()
message(STATUS "StreamKernel: skc on Clang ${version} (${SK_CLANG_LIBRARY})")

# The real files, so that a library in the linker's own folder leaves no run path behind.
file(REAL_PATH "${SK_CLANG_LIBRARY}" clangLibrary)
file(REAL_PATH "${SK_LLVM_LIBRARY}" llvmLibrary)
add_library(sk_clang INTERFACE)
target_include_directories(sk_clang SYSTEM INTERFACE "${SK_CLANG_INCLUDE_DIR}" "${SK_LLVM_INCLUDE_DIR}")
target_link_libraries(sk_clang INTERFACE "${clangLibrary}" "${llvmLibrary}")
add_library(sk_llvm INTERFACE)
target_include_directories(sk_llvm SYSTEM INTERFACE "${SK_LLVM_INCLUDE_DIR}")
target_link_libraries(sk_llvm INTERFACE "${llvmLibrary}")
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # LLVM's classes with an operator new of their own, inlined where assertions are compiled
  target_compile_options(sk_llvm INTERFACE -Wno-mismatched-new-delete)
endif()
