# SPDX-License-Identifier: MIT
#
# Builds project/ outside of this repository as another project would, runs its kernels, and checks that
# sk_add_kernels rebuilds what has changed and nothing else. Run by cmake -P with
#   WAY            find_package (an installation, moved after it was made) or add_subdirectory
#   WORK           a folder for this test alone
#   SOURCE BUILD   StreamKernel's source and build folder
#   SKC            the skc built there
#   GENERATOR      CMake's generator for the consumer
#   SETTINGS       -D options for the consumer, on which both builds must agree
#   CXX            the C++ compiler
cmake_minimum_required(VERSION 3.25)

# step(WHAT COMMAND...): runs a command and sets `output` to what it prints; a failure ends the test.
macro(step what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${what} failed (${status}):\n${output}")
  endif()
endmacro()

# built(WHAT [RUNS file...]): builds the consumer, and checks that skc runs for these .sk files only.
function(built what)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "RUNS")
  step("building ${what}" ${CMAKE_COMMAND} --build "${WORK}/build")
  foreach(file scale.sk solver/scale.sk)
    string(REGEX MATCH " skc ${file}" ran "${output}")
    if(file IN_LIST arg_RUNS AND NOT ran)
      message(FATAL_ERROR "${what}: skc did not run for ${file}:\n${output}")
    elseif(ran AND NOT file IN_LIST arg_RUNS)
      message(FATAL_ERROR "${what}: skc ran for ${file}:\n${output}")
    endif()
  endforeach()
endfunction()

# prints(EXPECTED): checks what the consumer prints, with GL and natively.
function(prints expected)
  foreach(device gl native)
    step("running the consumer" ${CMAKE_COMMAND} -E env SK_DEVICE=${device} "${WORK}/build/consumer")
    if(NOT output STREQUAL expected)
      message(FATAL_ERROR "on ${device} the consumer prints '${output}', not '${expected}'")
    endif()
  endforeach()
endfunction()

# edit(FILE OLD NEW): replaces a text in a file of the project.
function(edit file old new)
  file(READ "${WORK}/project/${file}" text)
  string(REPLACE "${old}" "${new}" changed "${text}")
  if(changed STREQUAL text)
    message(FATAL_ERROR "'${old}' is not in ${file}")
  endif()
  file(WRITE "${WORK}/project/${file}" "${changed}")
endfunction()

# readmeBlock(FENCE FILE): writes the code block of README.md with this fence to a file of README.md's project.
function(readmeBlock fence file)
  file(READ "${SOURCE}/README.md" text)
  string(FIND "${text}" "\n```${fence}\n" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "README.md has no block '${fence}'")
  endif()
  string(LENGTH "\n```${fence}\n" length)
  math(EXPR begin "${begin} + ${length}")
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "\n```\n" end)
  string(SUBSTRING "${text}" 0 ${end} text)
  file(WRITE "${WORK}/readme/${file}" "${text}\n")
endfunction()

# readmeProject(PLACE): pastes the three files of README.md to an empty folder, and checks that they build a program which
# prints what README.md says.
function(readmeProject place)
  readmeBlock("sk file=heat.sk" heat.sk)
  readmeBlock("c++ run kernels=heat.sk prints=1000" main.cpp)
  readmeBlock("cmake file=CMakeLists.txt" CMakeLists.txt)
  step("configuring README.md's project" ${CMAKE_COMMAND} -G "${GENERATOR}" -S "${WORK}/readme" -B "${WORK}/readme/build" ${place}
       ${SETTINGS})
  step("building README.md's project" ${CMAKE_COMMAND} --build "${WORK}/readme/build")
  step("running README.md's program" ${CMAKE_COMMAND} -E env SK_DEVICE=native "${WORK}/readme/build/app")
  if(NOT output STREQUAL "1000\n")
    message(FATAL_ERROR "README.md's program prints '${output}'")
  endif()
endfunction()

# relocatable(FOLDER): checks that no text file of the installation names a folder of this machine.
function(relocatable folder)
  file(GLOB_RECURSE files "${folder}/*.cmake" "${folder}/*.hpp")
  foreach(file IN LISTS files)
    file(READ "${file}" text)
    foreach(place "${SOURCE}" "${BUILD}" "${WORK}")
      string(FIND "${text}" "${place}" at)
      if(NOT at EQUAL -1)
        message(FATAL_ERROR "${file} names ${place}")
      endif()
    endforeach()
  endforeach()
endfunction()

file(REMOVE_RECURSE "${WORK}")
file(COPY "${CMAKE_CURRENT_LIST_DIR}/project" DESTINATION "${WORK}")

set(kinds static object shared)
if(WAY STREQUAL "find_package")
  step("installing" ${CMAKE_COMMAND} --install "${BUILD}" --prefix "${WORK}/prefix")
  file(RENAME "${WORK}/prefix" "${WORK}/moved")
  relocatable("${WORK}/moved")
  if(EXISTS "${BUILD}/bin/sk")
    step("asking the installed sk" "${WORK}/moved/bin/sk" --version)
    step("measuring a file by the installed sk" ${CMAKE_COMMAND} -E env --unset=SK_INCLUDE SK_CACHE=off
         "${WORK}/moved/bin/sk" accuracy "${WORK}/project/scale.sk" --skc "${SKC}" -I "${WORK}/project"
         --device native --size 64 --rounds 1)
  endif()
  set(place "-DCMAKE_PREFIX_PATH=${WORK}/moved")
  if(GENERATOR STREQUAL "Ninja")
    readmeProject("${place}")
  endif()
else()
  set(place "-DSTREAMKERNEL=${SOURCE}" "-DSK_SKC=${SKC}" -DLIBRARIES=)   # an installation is linked to every kind
  list(APPEND SETTINGS "-DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CURRENT_LIST_DIR}/reuse_object.sh")
  set(ENV{SK_OWN_BUILD} "${BUILD}")
  set(ENV{SK_TAKEN_IN} "${WORK}/build/streamkernel")
  set(kinds "")
endif()
step("configuring" ${CMAKE_COMMAND} -G "${GENERATOR}" -S "${WORK}/project" -B "${WORK}/build"
     ${place} ${SETTINGS})

built("anew" RUNS scale.sk solver/scale.sk)
prints("3 4 5 6 ")
foreach(kind IN LISTS kinds)
  step("running native code of a ${kind} library" ${CMAKE_COMMAND} -E env SK_DEVICE=native "${WORK}/build/uses_library_${kind}")
  if(NOT output STREQUAL "1.5")
    message(FATAL_ERROR "the ${kind} library prints '${output}', not '1.5'")
  endif()
endforeach()
if(kinds)
  step("running kernels of several libraries" ${CMAKE_COMMAND} -E env SK_DEVICE=native "${WORK}/build/parts")
  if(NOT output STREQUAL "10 14 6 8 7 9 1")
    message(FATAL_ERROR "kernels of several libraries print '${output}'")
  endif()
  foreach(device gl native)
    step("solving equations" ${CMAKE_COMMAND} -E env SK_DEVICE=${device} "${WORK}/build/equations")
    if(NOT output STREQUAL "converged 3.000000 the right-hand side has 7 elements, and the matrix 100 rows")
      message(FATAL_ERROR "on ${device} the solver prints '${output}'")
    endif()
  endforeach()
  foreach(header linear sparse_matrix)
    file(READ "${WORK}/moved/include/sk/${header}.hpp" text)
    if(text MATCHES "#include \"")
      message(FATAL_ERROR "sk/${header}.hpp includes what is not installed")
    endif()
  endforeach()
  step("installing a library with kernels" ${CMAKE_COMMAND} --install "${WORK}/build" --prefix "${WORK}/parts")
  file(WRITE "${WORK}/user.cpp" "#include <parts/near/near.sk.hpp>\nparts::Hit hit(const near::Choice& c) { return {c.t, parts::Back, {}}; }\n")
  step("compiling for the installed library" ${CXX} -std=c++20 -fsyntax-only -I "${WORK}/parts/include" -I "${WORK}/moved/include"
       "${WORK}/user.cpp")
  file(GLOB exported "${WORK}/parts/lib/cmake/*.cmake")
  foreach(file IN LISTS exported)
    file(READ "${file}" text)
    if(text MATCHES "${WORK}")
      message(FATAL_ERROR "${file} names ${WORK}")
    endif()
  endforeach()
endif()
built("again without a change")
edit(common.sk "factor = 2.0f" "factor = 3.0f")
built("after a change of an included file" RUNS scale.sk solver/scale.sk)
prints("4.5 6 7.5 9 ")
edit(scale.sk "factor * a" "2 * factor * a")
built("after a change of one file" RUNS scale.sk)
prints("6 9 12 15 ")

# Users build without assertions, which use variables that nothing else may use: what differs then compiles without a warning, too.
if(WAY STREQUAL "add_subdirectory")
  file(GLOB_RECURSE sources "${SOURCE}/runtime/src/*.cpp")
  set(text "")
  foreach(source IN LISTS sources)
    file(STRINGS "${source}" asserts REGEX "^ +assert\\(" LIMIT_COUNT 1)
    if(asserts)
      string(APPEND text "#include \"${source}\"\n")
    endif()
  endforeach()
  file(WRITE "${WORK}/unchecked.cpp" "${text}")
  set(generated runtime/src/assemble)
  step("compiling without assertions" ${CXX} -std=c++20 -fsyntax-only -DNDEBUG -Wall -Wextra -Werror
       -I "${SOURCE}/runtime/src" -I "${SOURCE}/runtime/include" -I "${WORK}/build/streamkernel/${generated}" "${WORK}/unchecked.cpp")
  # What objects of the other build were compiled with.
  file(GLOB headers RELATIVE "${BUILD}" "${BUILD}/${generated}/glsl_text/*.hpp")
  foreach(header IN LISTS headers)
    step("comparing ${header}" ${CMAKE_COMMAND} -E compare_files "${BUILD}/${header}" "${WORK}/build/streamkernel/${header}")
  endforeach()
endif()

# A mistake in a kernel stops the build with a message that names its line.
edit(scale.sk "* a * x" "* a * y")
execute_process(COMMAND ${CMAKE_COMMAND} --build "${WORK}/build"
                RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(status EQUAL 0 OR NOT output MATCHES "scale\\.sk:4:[0-9]+: error: ")
  message(FATAL_ERROR "a mistake in scale.sk gives status ${status} and:\n${output}")
endif()
edit(scale.sk "* a * y" "* a * x")
built("after the mistake" RUNS scale.sk)
prints("6 9 12 15 ")
