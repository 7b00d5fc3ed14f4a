# SPDX-License-Identifier: MIT
#
# The two ways that a folder becomes a target: sk_library and sk_unit_tests. A target's link line
# is also its include rule (tests/cli/include_rules checks what a link line cannot).

# sk_compile_options(TARGET): language level and warnings of our own code.
function(sk_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wcast-align
                         $<$<BOOL:${SK_WARNINGS_AS_ERRORS}>:-Werror>)
  if(SK_CHECKS)
    target_compile_options(${target} PRIVATE -UNDEBUG)   # build types other than Debug define it
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # g++ 12 sees overlapping copies in "a" + std::string() that are not there (GCC bug 105651)
    # and collects garbage in a heap of 128 MB again and again: with 500 MB, sources that are compiled together take a tenth less
    # time and a tenth more memory
    target_compile_options(${target} PRIVATE -Wno-restrict --param=ggc-min-heapsize=500000)
  endif()
endfunction()

# sk_library(TARGET SOURCES... ): a static library of this folder, included by its path below
# compiler/ or runtime/src/.
function(sk_library target)
  add_library(${target} STATIC ${ARGN})
  sk_compile_options(${target})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()

# sk_compile_together(TARGET [APART SOURCE...]): with SK_UNITY, compiles the sources of a target as one, so that what all of
# them include is read and instantiated once. APART names sources that stay alone
# because names in their anonymous namespaces are also another source's. (Precompiled headers of the compiler cost more than they
# save: g++ 12 writes 600 MB for Clang's, and reading these takes longer than reading the headers that a source needs.)
function(sk_compile_together target)
  if(NOT SK_UNITY)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 together "" "" "APART")
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  if(together_APART)
    set_source_files_properties(${together_APART} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  # A local name of one source may be a global name of another, and what g++ 12 inlines across sources it warns of wrongly. (The
  # preset debug compiles sources one by one.)
  target_compile_options(${target} PRIVATE -Wno-shadow -Wno-stringop-overflow)
endfunction()

# How sources are compiled that parse command lines and write reports: -Og takes two thirds of the time.
set(SK_COMMAND_LINE_OPTIONS $<$<CONFIG:Release>:-Og>)

# sk_command_line(SOURCE...): these sources are of that kind.
function(sk_command_line)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "${SK_COMMAND_LINE_OPTIONS}")
endfunction()

# sk_compile_for_this_machine(): kernels of this folder and those below run on this machine alone, unless SK_LEVELS says otherwise.
macro(sk_compile_for_this_machine)
  if(NOT SK_LEVELS AND NOT CMAKE_CROSSCOMPILING AND NOT CMAKE_CXX_COMPILER_TARGET)
    set(SK_LEVELS native)
  endif()
endmacro()

# How tests are compiled: they spend their time in the code under test, and optimising the tests themselves takes longer than it gains.
set(SK_TEST_OPTIONS $<$<CONFIG:Release>:-O0>)

# sk_test_headers(TARGET): a program of tests takes Catch2's header as it was compiled for sk_test_main, which it links.
function(sk_test_headers target)
  target_precompile_headers(${target} REUSE_FROM sk_test_main)
endfunction()

# sk_optimise(SOURCE...): these sources of tests compute for long, so that -O1 costs less than it saves. They are compiled alone.
function(sk_optimise)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "$<$<CONFIG:Release>:-O1>"
                              SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# sk_unit_tests(TARGET SOURCES... [APART SOURCE...]): the *_test.cpp files of this folder as one program, linked
# with the folder's TARGET and Catch2, registered with CTest. APART: as for sk_compile_together.
function(sk_unit_tests target)
  if(NOT SK_BUILD_TESTS)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 tests "" "" "APART")
  add_executable(${target}_test ${tests_UNPARSED_ARGUMENTS} ${tests_APART})
  sk_compile_options(${target}_test)
  target_link_libraries(${target}_test PRIVATE ${target} sk_test_main)
  sk_test_headers(${target}_test)
  sk_compile_together(${target}_test APART ${tests_APART})
  add_test(NAME ${target} COMMAND ${target}_test)
endfunction()
