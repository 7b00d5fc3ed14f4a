# SPDX-License-Identifier: MIT
#
# cmake -D IN=FOLDER -D OUT=FILE.hpp -P SkEmbedPage.cmake: the page of FOLDER/page.html as constants of C++, in one file: style sheets
# and scripts that it links are put in the places of their links. `sk::shadow::page` has parts, since some compilers limit a literal.
file(READ "${IN}/page.html" page)
string(REGEX MATCHALL "<link rel=\"stylesheet\" href=\"[a-z_.]+\">|<script src=\"[a-z_.]+\"></script>" links "${page}")
foreach(link IN LISTS links)
  string(REGEX REPLACE ".*\"([a-z_.]+)\">.*" "\\1" name "${link}")
  file(READ "${IN}/${name}" text)
  if(name MATCHES "[.]css$")
    string(REPLACE "${link}" "<style>\n${text}</style>" page "${page}")
  else()
    string(REPLACE "${link}" "<script>\n${text}</script>" page "${page}")
  endif()
endforeach()
if(NOT page MATCHES "/\\*REPORT\\*/null")
  message(FATAL_ERROR "${IN}/page.html has no place for the report: /*REPORT*/null")
endif()
# A literal ends at the first end of a line after 12,000 bytes, so that no character of UTF-8 is cut.
set(parts "")
string(LENGTH "${page}" length)
while(length GREATER 12000)
  string(SUBSTRING "${page}" 12000 -1 rest)
  string(FIND "${rest}" "\n" end)
  math(EXPR end "${end} + 12001")
  string(SUBSTRING "${page}" 0 ${end} part)
  string(SUBSTRING "${page}" ${end} -1 page)
  string(APPEND parts "    R\"page(${part})page\",\n")
  string(LENGTH "${page}" length)
endwhile()
string(APPEND parts "    R\"page(${page})page\",\n")
file(WRITE "${OUT}" "// Generated from ${IN}. Edit the files there instead.\n#pragma once\n\n#include <string_view>\n\n"
  "namespace sk::shadow {\n\ninline constexpr std::string_view pageParts[] = {\n${parts}};\n\n}  // namespace sk::shadow\n")
