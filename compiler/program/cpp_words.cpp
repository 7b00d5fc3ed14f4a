// SPDX-License-Identifier: MIT
//
// The table behind isGlobalCName.
#include <algorithm>
#include <iterator>

#include "program/cpp_names.hpp"

namespace skc::emit {
namespace {

/// <math.h>; each also with f and l at its end.
constexpr std::string_view mathFunctions[] = {
    "acos",     "acosh",  "asin",   "asinh",   "atan",      "atan2",     "atanh",       "cbrt",  "ceil",
    "copysign", "cos",    "cosh",   "drem",    "erf",       "erfc",      "exp",         "exp10", "exp2",
    "expm1",    "fabs",   "fdim",   "finite",  "floor",     "fma",       "fmax",        "fmin",  "fmod",
    "frexp",    "gamma",  "hypot",  "ilogb",   "isinf",     "isnan",     "j0",          "j1",    "jn",
    "ldexp",    "lgamma", "llrint", "llround", "log",       "log10",     "log1p",       "log2",  "logb",
    "lrint",    "lround", "modf",   "nan",     "nearbyint", "nextafter", "nexttoward",  "pow",   "remainder",
    "remquo",   "rint",   "round",  "scalb",   "scalbln",   "scalbn",    "significand", "sin",   "sincos",
    "sinh",     "sqrt",   "tan",    "tanh",    "tgamma",    "trunc",     "y0",          "y1",    "yn"};

/// <ctype.h> <signal.h> <stdio.h> <stdlib.h> <string.h> <strings.h> <time.h> <unistd.h>, and sk's own.
constexpr std::string_view otherNames[] = {
    "abort",   "abs",     "access",  "acct",    "alarm",    "atexit",  "atof",    "atoi",     "atol",
    "atoll",   "bcmp",    "bcopy",   "brk",     "bsearch",  "bzero",   "calloc",  "chdir",    "chown",
    "clock",   "close",   "crypt",   "daemon",  "div",      "dup",     "encrypt", "exit",     "fclose",
    "feof",    "ferror",  "fflush",  "ffs",     "fgetc",    "fgets",   "fopen",   "fork",     "fprintf",
    "fputc",   "fputs",   "fread",   "free",    "fscanf",   "fseek",   "ftell",   "fwrite",   "getc",
    "getenv",  "getpid",  "getw",    "index",   "isalnum",  "isalpha", "isascii", "isdigit",  "islower",
    "isprint", "ispunct", "isspace", "isupper", "kill",     "labs",    "ldiv",    "link",     "llabs",
    "lldiv",   "lseek",   "main",    "malloc",  "mblen",    "memchr",  "memcmp",  "memcpy",   "memmove",
    "memset",  "mktime",  "nice",    "pause",   "perror",   "pipe",    "pread",   "printf",   "profil",
    "psignal", "putc",    "putchar", "putenv",  "puts",     "putw",    "pwrite",  "qsort",    "raise",
    "rand",    "random",  "read",    "realloc", "remove",   "rename",  "rewind",  "rindex",   "rmdir",
    "sbrk",    "scanf",   "select",  "setenv",  "signal",   "sk",      "sleep",   "snprintf", "sprintf",
    "srand",   "srandom", "sscanf",  "std",     "strcat",   "strchr",  "strcmp",  "strcpy",   "strdup",
    "strlen",  "strncat", "strncmp", "strncpy", "strsep",   "strstr",  "strtod",  "strtof",   "strtok",
    "strtol",  "swab",    "symlink", "sync",    "system",   "tempnam", "time",    "times",    "tmpfile",
    "tmpnam",  "toascii", "tolower", "toupper", "truncate", "ttyname", "ungetc",  "unlink",   "usleep",
    "vfork",   "vprintf", "wait",    "write"};

static_assert(std::ranges::is_sorted(mathFunctions) && std::ranges::is_sorted(otherNames),
              "for binary search");

template <class Table>
bool contains(const Table& table, std::string_view name) {
  return std::binary_search(std::begin(table), std::end(table), name);
}

}  // namespace

bool isGlobalCName(std::string_view name) {
  if (contains(otherNames, name) || contains(mathFunctions, name)) return true;
  const bool hasSuffix = !name.empty() && (name.back() == 'f' || name.back() == 'l');
  return hasSuffix && contains(mathFunctions, name.substr(0, name.size() - 1));
}

}  // namespace skc::emit
