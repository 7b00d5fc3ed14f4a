# SPDX-License-Identifier: MIT
#
# What sk_add_kernels says to a CMakeLists.txt that uses it wrongly. Each case is a project without a
# language whose configuration must stop with one message. Run by cmake -P with WORK, an empty folder.
cmake_minimum_required(VERSION 3.25)
cmake_path(SET kernels NORMALIZE "${CMAKE_CURRENT_LIST_DIR}/../../compiler/SkKernels.cmake")

# expect(MESSAGE CODE): configuring CODE fails, and says MESSAGE.
function(expect message code)
  file(REMOVE_RECURSE "${WORK}")
  file(MAKE_DIRECTORY "${WORK}/below")
  file(WRITE "${WORK}/CMakeLists.txt"
    "cmake_minimum_required(VERSION 3.25)\nproject(wrong NONE)\ninclude(\"${kernels}\")\n${code}\n")
  file(WRITE "${WORK}/below/CMakeLists.txt" "add_library(far OBJECT far.cpp)\n")
  file(WRITE "${WORK}/heat.sk" "")
  file(WRITE "${WORK}/heat.cl" "")
  execute_process(COMMAND ${CMAKE_COMMAND} -S "${WORK}" -B "${WORK}/build"
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  string(FIND "${output}" "${message}" place)
  if(status EQUAL 0 OR place EQUAL -1)
    message(FATAL_ERROR "${code}\nshould fail with: ${message}\nstatus ${status}: ${output}")
  endif()
endfunction()

set(app "add_library(app OBJECT main.cpp)\n")
expect("sk_add_kernels(app): there is no target 'app'; call add_executable or add_library first"
       "sk_add_kernels(app heat.sk)")
expect("sk_add_kernels(app): no such file: ${WORK}/haet.sk" "${app}sk_add_kernels(app haet.sk)")
expect("sk_add_kernels(app): no such file: ${WORK}/below" "${app}sk_add_kernels(app below)")
expect("sk_add_kernels(app): not a .sk file: ${WORK}/heat.cl" "${app}sk_add_kernels(app heat.cl)")
expect("sk_add_kernels(app): give one .sk file or more" "${app}sk_add_kernels(app TARGETS fragment)")
expect("sk_add_kernels(headers): 'headers' compiles no sources"
       "add_library(headers INTERFACE)\nsk_add_kernels(headers heat.sk)")
expect("sk_add_kernels(tool): 'tool' compiles no sources"
       "add_executable(tool IMPORTED)\nsk_add_kernels(tool heat.sk)")
expect("sk_add_kernels(far): 'far' is made in ${WORK}/below; call sk_add_kernels there"
       "add_subdirectory(below)\nsk_add_kernels(far heat.sk)")
expect("SK_SKC names no file: /no/such/skc" "set(SK_SKC /no/such/skc)\nsk_find_skc()")
file(REMOVE_RECURSE "${WORK}")
