# SPDX-License-Identifier: MIT
#
# sk_add_kernels: .sk files as sources of a target. Used by this project and, installed beside
# StreamKernelConfig.cmake, by every project that uses it. It must not assume that skc is built here.
include_guard(GLOBAL)
cmake_policy(VERSION 3.25)

# sk_add_kernels(<target> <file.sk>...
#                [TARGETS <fragment|compute|native>...]     what skc emits for (default: skc's own)
#                [INCLUDE_DIRECTORIES <folder>...]          searched by #include in .sk files
#                [OPTIONS <option>...])                     further options of skc
#
# Compiles each file at build time, again when it or a file that it includes has changed, and adds
# the stubs and the object file with the native code to <target>. The target's own sources then
# include a kernel's header by the path of its .sk file: "heat.sk.hpp", "solver/heat.sk.hpp"; files
# outside of the source folder by their name. So do the sources of what links <target>, if that is a
# library. To be called in the folder that makes the target, which also links sk::runtime (PUBLIC, if
# others include its kernels' headers). With the option --quad the target also links libquadmath, where
# __float128 is another type than long double.
#
# .sk files and the target's sources find headers that they share in the source folder and in
# INCLUDE_DIRECTORIES. A library that installs kernels' headers installs such headers beside them.
#
# The variable SK_LEVELS names the levels of the CPU that native code is compiled for, as skc's --levels does: native, for
# programs that run on this machine alone, compiles soonest. Without it, native code has all levels.
#
# An object library must be linked by what uses it: $<TARGET_OBJECTS:...> has only what CMake compiles.
function(sk_add_kernels target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "TARGETS;INCLUDE_DIRECTORIES;OPTIONS")
  sk_check_kernel_target("${target}")
  if(NOT arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "sk_add_kernels(${target}): give one .sk file or more")
  endif()

  set(options ${arg_OPTIONS})
  if(arg_TARGETS)
    list(JOIN arg_TARGETS "," targets)
    list(APPEND options "--target=${targets}")
  endif()
  sk_native_options(options)
  foreach(folder IN LISTS arg_INCLUDE_DIRECTORIES)
    file(REAL_PATH "${folder}" folder BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
    list(APPEND options "-I${folder}")
    sk_include_for_kernels("${target}" "${folder}")
  endforeach()
  list(APPEND options "-I${CMAKE_CURRENT_SOURCE_DIR}")
  sk_include_for_kernels("${target}" "${CMAKE_CURRENT_BINARY_DIR}/${target}.sk")
  sk_include_for_kernels("${target}" "${CMAKE_CURRENT_SOURCE_DIR}")

  if("--quad" IN_LIST options AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|i.86|ppc64le")
    target_link_libraries(${target} PRIVATE quadmath)
  endif()

  foreach(file IN LISTS arg_UNPARSED_ARGUMENTS)
    sk_add_kernel_file("${target}" "${file}" "${options}")
  endforeach()
endfunction()

# sk_include_for_kernels(TARGET FOLDER): adds a folder in which compilers find what kernels need, for the target and for what links it.
# An installed library has no such folders.
function(sk_include_for_kernels target folder)
  get_target_property(type "${target}" TYPE)
  if(type MATCHES "^(STATIC|SHARED|OBJECT)_LIBRARY$")
    target_include_directories(${target} PUBLIC "$<BUILD_INTERFACE:${folder}>")
  else()
    target_include_directories(${target} PRIVATE "${folder}")
  endif()
endfunction()

# sk_native_options(LIST): appends to skc's options what the build says of native code.
function(sk_native_options list)
  set(options ${${list}} "$<$<CONFIG:Debug,RelWithDebInfo>:-g>" "$<$<CONFIG:Debug>:-O0>")
  if(NOT "${options}" MATCHES "--target-triple")
    if(CMAKE_CXX_COMPILER_TARGET)
      list(APPEND options "--target-triple=${CMAKE_CXX_COMPILER_TARGET}")
    elseif(CMAKE_CROSSCOMPILING AND CMAKE_LIBRARY_ARCHITECTURE)
      list(APPEND options "--target-triple=${CMAKE_LIBRARY_ARCHITECTURE}")
    elseif(CMAKE_CROSSCOMPILING)
      string(TOLOWER "${CMAKE_SYSTEM_PROCESSOR}-${CMAKE_SYSTEM_NAME}-gnu" triple)
      list(APPEND options "--target-triple=${triple}")
    endif()
  endif()
  if(SK_LEVELS AND NOT "${options}" MATCHES "--levels")
    list(APPEND options "--levels=${SK_LEVELS}")
  endif()
  set(${list} ${options} PARENT_SCOPE)
endfunction()

# sk_check_kernel_target(TARGET): stops where sk_add_kernels cannot add sources to it.
function(sk_check_kernel_target target)
  if(NOT TARGET "${target}")
    message(FATAL_ERROR "sk_add_kernels(${target}): there is no target '${target}'; "
                        "call add_executable or add_library first")
  endif()
  get_target_property(type "${target}" TYPE)
  get_target_property(imported "${target}" IMPORTED)
  if(imported OR NOT type MATCHES "^(EXECUTABLE|STATIC_LIBRARY|SHARED_LIBRARY|MODULE_LIBRARY|OBJECT_LIBRARY)$")
    message(FATAL_ERROR "sk_add_kernels(${target}): '${target}' compiles no sources; "
                        "give an executable or a library of this project")
  endif()
  get_target_property(folder "${target}" SOURCE_DIR)
  if(NOT folder STREQUAL CMAKE_CURRENT_SOURCE_DIR)
    message(FATAL_ERROR "sk_add_kernels(${target}): '${target}' is made in ${folder}; call sk_add_kernels there")
  endif()
endfunction()

# sk_add_kernel_file(TARGET FILE OPTIONS): one file's command, outputs and include path.
function(sk_add_kernel_file target file options)
  cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE OUTPUT_VARIABLE source)
  if(NOT EXISTS "${source}" OR IS_DIRECTORY "${source}")
    get_source_file_property(generated "${source}" GENERATED)
    if(NOT generated)
      message(FATAL_ERROR "sk_add_kernels(${target}): no such file: ${source}")
    endif()
  endif()
  cmake_path(GET source EXTENSION LAST_ONLY extension)
  if(NOT extension STREQUAL ".sk")
    message(FATAL_ERROR "sk_add_kernels(${target}): not a .sk file: ${source}")
  endif()

  # The tree of outputs mirrors the source folder. What lies outside gets a folder of its own, so that
  # files of one name never meet.
  set(tree "${CMAKE_CURRENT_BINARY_DIR}/${target}.sk")
  cmake_path(IS_PREFIX CMAKE_CURRENT_SOURCE_DIR "${source}" NORMALIZE inside)
  cmake_path(GET source PARENT_PATH folder)
  if(inside)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" OUTPUT_VARIABLE below)
    cmake_path(SET output NORMALIZE "${tree}/${below}")
  else()
    string(MD5 hash "${folder}")
    string(SUBSTRING "${hash}" 0 8 hash)
    set(output "${tree}/outside-${hash}")
    sk_include_for_kernels("${target}" "${output}")
    sk_include_for_kernels("${target}" "${folder}")
  endif()
  string(REGEX REPLACE "/\\.?$" "" output "${output}")
  cmake_path(GET source FILENAME name)
  file(MAKE_DIRECTORY "${output}")

  set(outputs "${output}/${name}.hpp" "${output}/${name}.cpp")
  if(NOT "${options}" MATCHES "--target=" OR "${options}" MATCHES "--target=[a-z,]*native")
    set(object "${output}/${name}.o")
  endif()
  # Ninja holds that the depfile's first target is the first output.
  add_custom_command(
    OUTPUT ${outputs} ${object}
    COMMAND sk::skc "${options}" -o "${output}" "--depfile=${output}/${name}.d" "${source}"
    DEPENDS "${source}" "$<TARGET_FILE:sk::skc>"
    DEPFILE "${output}/${name}.d"
    COMMENT "skc ${file}"
    VERBATIM COMMAND_EXPAND_LISTS)
  target_sources(${target} PRIVATE ${outputs})
  # A unity build would read every stub into one source; each is large enough alone. It needs no precompiled headers.
  set_source_files_properties("${output}/${name}.cpp" PROPERTIES
                              SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
  if(object)
    sk_add_object("${target}" "${object}")
  endif()
endfunction()

# sk_add_object(TARGET OBJECT): links an object file that skc writes. CMake does not hand on the objects of
# an object library that it has not compiled, so that each target which links the library gets this one.
function(sk_add_object target object)
  set_source_files_properties("${object}" PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  get_target_property(type "${target}" TYPE)
  if(type STREQUAL "OBJECT_LIBRARY")
    target_sources(${target} INTERFACE "$<BUILD_INTERFACE:${object}>")
  else()
    target_sources(${target} PRIVATE "${object}")
  endif()
endfunction()

# sk_find_skc([PLACE...]): makes sk::skc of an installed skc: the one that SK_SKC names, else the one
# in these folders, else the one on PATH.
function(sk_find_skc)
  if(SK_SKC)
    set(skc "${SK_SKC}")
    if(NOT EXISTS "${skc}")
      message(FATAL_ERROR "StreamKernel: SK_SKC names no file: ${skc}")
    endif()
  else()
    find_program(skc skc HINTS ${ARGN} NO_CACHE NO_CMAKE_FIND_ROOT_PATH)
    if(NOT skc)
      message(FATAL_ERROR "StreamKernel: no skc found on PATH; give one by -DSK_SKC=<file>, "
                          "or build it (-DSK_BUILD_COMPILER=ON)")
    endif()
  endif()
  add_executable(sk::skc IMPORTED GLOBAL)
  set_target_properties(sk::skc PROPERTIES IMPORTED_LOCATION "${skc}")
endfunction()
