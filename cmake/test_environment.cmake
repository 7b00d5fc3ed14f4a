# SPDX-License-Identifier: MIT
#
# Read by ctest before it runs anything: the environment of tests that name no other, and of what they start. Variables that are
# set outside stay.
function(default variable value)
  if(NOT DEFINED ENV{${variable}})
    set(ENV{${variable}} "${value}")
  endif()
endfunction()

# Tests run side by side, so that threads that wait for others of their program would take the time of other tests.
default(OMP_WAIT_POLICY passive)
# A software renderer compiles programs for longer than tests compute, so that Mesa's leaves out LLVM's optimisations. Tests that
# are about what compilers make of floats have them all: they set this to nothing.
default(GALLIVM_PERF nopt)
# Vectors of half the width take that compiler two thirds of the time. Tests that need the width that users have clear this.
default(LP_NATIVE_VECTOR_WIDTH 128)
# Mesa keeps compiled programs, and its keys leave out the width: a vertex program compiled for 256 bits, run with buffers for 128,
# writes beyond them. So each width has a folder of its own.
set(mesaCache "@PROJECT_BINARY_DIR@/tests/cache/mesa_$ENV{LP_NATIVE_VECTOR_WIDTH}")
file(MAKE_DIRECTORY "${mesaCache}" "@mesaCacheOfFullWidth@")
default(MESA_SHADER_CACHE_DIR "${mesaCache}")
# What is kept of such a driver, as the trial of its arithmetic, is not for the programs of whoever runs the tests.
default(SK_CACHE "@PROJECT_BINARY_DIR@/tests/cache/unoptimised")
