# SPDX-License-Identifier: MIT
#
# cmake -D IN=FILE.glsl -D OUT=FILE.hpp -P SkEmbedGlsl.cmake: GLSL as constants of C++. A section of the file begins with a line
# `//// name` and becomes `sk::assemble::library::name`, which begins with an empty line. What stands above the first section is
# for readers of the file.
file(READ "${IN}" text)
string(FIND "${text}" "\n//// " first)
if(first EQUAL -1)
  message(FATAL_ERROR "${IN} has no section: a line `//// name`")
endif()
string(SUBSTRING "${text}" ${first} -1 text)
string(REGEX REPLACE "\n+//// ([A-Za-z0-9]+)\n" "\n)glsl\";\nconstexpr std::string_view \\1 = R\"glsl(\n" text "${text}")
# what the first section's head has closed was never open, and the last one is still open
string(REGEX REPLACE "^\n\\)glsl\";\n" "" text "${text}")
get_filename_component(name "${IN}" NAME)
file(WRITE "${OUT}" "// Generated from ${name}. Edit that file instead.\n#pragma once\n\n#include <string_view>\n\n"
  "namespace sk::assemble::library {\n\n${text})glsl\";\n\n}  // namespace sk::assemble::library\n")
