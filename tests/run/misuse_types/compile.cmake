# SPDX-License-Identifier: MIT
#
# Compiles calls.cpp rightly, and once for each WRONG: the compiler must refuse it, and say why.
# Usage: cmake -DCXX=... -DINCLUDES=a:b:c -P compile.cmake
cmake_policy(VERSION 3.25)

string(REPLACE ":" ";-I" includes "-I${INCLUDES}")
set(input "is not the one that the kernel's input declares")
set(output "is not the one that the kernel's output declares")
set(constant "the kernel writes this stream, but it is const")
set(expected "^$" "${input}" "${output}" "${constant}" "${output}" "no match for call|no matching function" "${input}" "${constant}")

foreach(wrong RANGE 7)
  execute_process(
    COMMAND ${CXX} -std=c++20 -fsyntax-only -DWRONG=${wrong} ${includes} "${CMAKE_CURRENT_LIST_DIR}/calls.cpp"
    RESULT_VARIABLE status OUTPUT_VARIABLE text ERROR_VARIABLE text)
  list(GET expected ${wrong} wanted)
  if(wrong EQUAL 0 AND NOT status EQUAL 0)
    message(FATAL_ERROR "the right calls do not compile:\n${text}")
  elseif(NOT wrong EQUAL 0 AND status EQUAL 0)
    message(FATAL_ERROR "WRONG=${wrong} compiles")
  elseif(NOT text MATCHES "${wanted}")
    message(FATAL_ERROR "WRONG=${wrong} is refused without '${wanted}':\n${text}")
  endif()
endforeach()
