# SPDX-License-Identifier: MIT
#
# The code of exact sums does not compile where the compiler may round as it likes.
# Usage: cmake -DCXX=... -DSOURCE=runtime/src -P compile.cmake
cmake_policy(VERSION 3.25)

foreach(options IN ITEMS "" "-ffast-math" "-Ofast")
  execute_process(
    COMMAND ${CXX} -std=c++20 -fsyntax-only -x c++ ${options} "${SOURCE}/support/rounds_as_written.hpp"
    RESULT_VARIABLE status OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(options STREQUAL "")
    if(NOT status EQUAL 0)
      message(FATAL_ERROR "without options, it does not compile:\n${text}")
    endif()
  elseif(status EQUAL 0)
    message(FATAL_ERROR "${options} compiles")
  elseif(NOT text MATCHES "compile StreamKernel without -ffast-math and -Ofast")
    message(FATAL_ERROR "${options} is refused for another reason:\n${text}")
  endif()
endforeach()

# Every source that adds exactly says so.
foreach(name IN ITEMS native/exact_accumulator native/sum_floats)
  file(STRINGS "${SOURCE}/${name}.cpp" lines REGEX "support/rounds_as_written.hpp")
  if(NOT lines)
    message(FATAL_ERROR "${name}.cpp does not include support/rounds_as_written.hpp")
  endif()
endforeach()
