# SPDX-License-Identifier: MIT
#
# Compiles calls.cpp without WRONG, which must succeed, and with each WRONG, which the compiler must reject and explain.
# Usage: cmake -DCXX=... -DINCLUDES=a:b:c -P compile.cmake
cmake_policy(VERSION 3.25)

string(REPLACE ":" ";-I" includes "-I${INCLUDES}")
set(message_1 "the kernel writes this stream, but it is const")
set(message_2 "${message_1}")
set(message_3 "the starts of rows are a stream on the device")
set(message_4 "kernels take streams, and this is memory of the host")
set(message_5 "a stream holds bool, float")
foreach(wrong RANGE 5)
  execute_process(
    COMMAND ${CXX} -std=c++20 -fsyntax-only -DWRONG=${wrong} ${includes} "${CMAKE_CURRENT_LIST_DIR}/calls.cpp"
    RESULT_VARIABLE status OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(wrong EQUAL 0)
    if(NOT status EQUAL 0)
      message(FATAL_ERROR "the right call does not compile:\n${text}")
    endif()
  elseif(status EQUAL 0)
    message(FATAL_ERROR "WRONG=${wrong} compiles")
  elseif(NOT text MATCHES "StreamKernel: ${message_${wrong}}")
    message(FATAL_ERROR "WRONG=${wrong} is refused for another reason:\n${text}")
  endif()
endforeach()
