// SPDX-License-Identifier: MIT
//
// The tables behind isGlobalCName, isCTag and isMacro: what glibc and libstdc++ declare in the headers that sk/sk.hpp includes, and in
// those of the C library that programs include beside it.
#include "program/cpp_names.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "ir/print.hpp"
#include "program/shared_headers.hpp"
#include "program/stream_structs.hpp"
#include "program/stub_parts.hpp"
#include "support/namer.hpp"

namespace skc::emit {
namespace {

using namespace ir;

bool isReservedInGlobalScope(std::string_view name) { return isGlobalCName(name) || isMacro(name); }
bool isReservedForStruct(std::string_view name) { return isReservedInGlobalScope(name) || isCTag(name); }

/// The names of each namespace.
class Scopes {
 public:
  /// Structs, their aliases and namespaces are there before kernels.
  explicit Scopes(const Module& module) {
    for (const std::uint32_t index : usedStructs(module)) {
      const Struct& type = module.structs[index];
      Namer& names = namesOf(type.scope);
      names.reserve(cppName(module, type));
      for (const std::string& alias : type.aliases) names.reserve(alias);
      reserveNamespaces(type.scope);
    }
    for (const BundleType& bundle : module.bundleTypes) {
      namesOf(bundle.scope).reserve(cppName(module, bundle));
      reserveNamespaces(bundle.scope);
    }
    for (const Kernel& kernel : module.kernels) reserveNamespaces(kernel.scope);
    for (const DeclaredStream& stream : module.streams) reserveNamespaces(stream.scope);
  }

  Namer& namesOf(const std::vector<std::string>& scope) {
    return scopes_.try_emplace(qualifier(scope), scope.empty() ? isReservedInGlobalScope : isMacro)
        .first->second;
  }

 private:
  void reserveNamespaces(std::vector<std::string> scope) {
    while (!scope.empty()) {
      std::string name = std::move(scope.back());
      scope.pop_back();
      namesOf(scope).reserve(std::move(name));
    }
  }

  std::map<std::string, Namer> scopes_;
};

}  // namespace

std::string pascalCase(std::string_view name) {
  std::string result;
  bool startsWord = true;
  for (char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && std::isalnum(byte) == 0) {
      startsWord = true;
      continue;
    }
    result += startsWord && byte < 0x80 ? static_cast<char>(std::toupper(byte)) : c;
    startsWord = false;
  }
  const bool isName = !result.empty() && std::isdigit(static_cast<unsigned char>(result.front())) == 0;
  return isName ? result : "K" + result;
}

std::string camelCase(std::string_view name) {
  std::string result = pascalCase(name);
  const auto first = static_cast<unsigned char>(result.front());
  if (first < 0x80) result.front() = static_cast<char>(std::tolower(first));
  return result;
}

std::vector<Callable> callables(const Module& module) {
  std::vector<Callable> list;
  std::vector<const Kernel*> kernels;  // the first of each callable
  std::map<std::pair<std::vector<std::string>, std::string>, std::size_t> known;
  const auto callableOf = [&](const Kernel& kernel) -> Callable& {
    const auto [callable, isNew] = known.try_emplace({kernel.scope, kernel.name}, list.size());
    if (isNew) {
      kernels.push_back(&kernel);
      list.push_back({kernel.scope, {}, {}, {}});
    }
    return list[callable->second];
  };
  std::size_t unit = 0;
  for (const Kernel& kernel : module.kernels) {
    if (!isUnit(kernel)) continue;
    if (!kernel.isOfPipeline) callableOf(kernel).units.push_back(unit);
    ++unit;
  }
  for (std::size_t i = 0; i < module.pipelines.size(); ++i) {
    if (!module.pipelines[i].isKernel) callableOf(module.pipelines[i].face).pipelines.push_back(i);
  }
  Scopes scopes(module);
  for (std::size_t i = 0; i < list.size(); ++i)
    list[i].object = scopes.namesOf(list[i].scope).take(kernels[i]->name);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string_view word = list[i].units.empty() ? "pipeline" : wordOf(*kernels[i]);
    const std::string type = pascalCase(kernels[i]->name) + pascalCase(word);
    list[i].type = scopes.namesOf(list[i].scope).take(type);
  }
  return list;
}

std::vector<const Kernel*> overloadsOf(const Module& module, const Callable& callable) {
  std::vector<const Kernel*> units, overloads;
  for (const Kernel& kernel : module.kernels) {
    if (isUnit(kernel)) units.push_back(&kernel);
  }
  for (const std::size_t unit : callable.units) overloads.push_back(units[unit]);
  for (const std::size_t pipeline : callable.pipelines) overloads.push_back(&module.pipelines[pipeline].face);
  return overloads;
}

std::string cppType(const Module& module, Type type, const std::vector<std::string>& scope) {
  if (type.isVector() || type.isMatrix()) return "sk::" + print(module, type);
  if (type.isScalar()) return std::string(row(type.scalar).cpp);
  const Struct& entry = module.structs[type.index];
  const std::string name = cppName(module, entry);
  return entry.scope == scope ? name : qualifier(entry.scope) + name;
}

std::string cppType(const Module& module, const BundleType& bundle, const std::vector<std::string>& scope) {
  return (bundle.scope == scope ? "" : qualifier(bundle.scope)) + cppName(module, bundle);
}

std::string cppName(const Module& module, const Struct& type) {
  if (isShared(module, type)) return type.name;
  Namer names(type.scope.empty() ? isReservedForStruct : isMacro);
  const auto isSame = [&](const Struct& other) {
    return other.name == type.name && other.scope == type.scope;
  };
  if (std::ranges::count_if(module.structs, isSame) == 1) return names.take(type.name);
  // Instances of a template, and structs within structs.
  for (const std::uint32_t index : usedStructs(module)) {
    const Struct& other = module.structs[index];
    if (&other == &type) break;
    if (isSame(other)) names.take(other.name);
  }
  return names.take(type.name);
}

std::string cppName(const Module& module, const BundleType& bundle) {
  const auto isOther = [&](const BundleType& other) {
    return other.name == bundle.name && other.scope == bundle.scope &&
           bundleMembers(module, other, {}) != bundleMembers(module, bundle, {});
  };
  Namer names(bundle.scope.empty() ? isReservedForStruct : isMacro);
  if (bundle.arguments.empty() || std::ranges::none_of(module.bundleTypes, isOther))
    return names.take(bundle.name);
  // Structs of the program may have the name of the instance.
  const auto reserve = [&](const auto& type) {
    if (type.scope == bundle.scope) names.reserve(type.name);
  };
  std::ranges::for_each(module.structs, reserve);
  for (const BundleType& other : module.bundleTypes) {
    if (other.arguments.empty()) reserve(other);
  }
  return names.take(bundle.name + bundle.arguments);
}

std::string cppName(const Kernel& kernel, const KernelParam& param) {
  std::string name = param.name;
  const auto isTaken = [&] {
    return isMacro(name) ||
           (name != param.name && std::ranges::count(kernel.params, name, &KernelParam::name) > 0);
  };
  while (isTaken()) name += '_';
  return name;
}

namespace {

/// Why C++ has a kernel or struct of this name, if it is not its own name.
std::string_view whatHas(const std::string& name, bool isGlobal) {
  if (isMacro(name)) return "a macro";
  return isGlobal && (isGlobalCName(name) || isCTag(name)) ? "declared by headers of C++"
                                                           : "a type's name, too";
}

void reportName(Diagnostics& diagnostics, Loc loc, std::string_view kind, const std::string& name,
                const std::string& given, bool isGlobal) {
  if (name == given) return;
  const bool helps = isGlobal && !isMacro(name);
  diagnostics.report(Diag::NameTaken, loc,
                     {name, whatHas(name, isGlobal), "C++", kind, given,
                      helps ? "in a namespace it would keep its name" : "another name would stay"});
}

void reportAlike(const Module& module, const std::vector<const Kernel*>& overloads,
                 Diagnostics& diagnostics) {
  std::map<std::string, const Kernel*> taken;
  std::vector<const Kernel*> distinct;
  for (const SameFunction& function : sameFunctions(module, overloads)) {
    const bool isChosen = !function.choosers.empty();
    distinct.insert(distinct.end(), function.kernels.begin(),
                    isChosen ? function.kernels.begin() + 1 : function.kernels.end());
  }
  for (const Kernel* kernel : distinct) {
    for (const Form form : formsOf(*kernel)) {
      for (const Uniforms uniforms : uniformsOf(*kernel)) {
        const std::string types = parameterTypes(module, *kernel, form, uniforms);
        const auto [entry, isNew] = taken.emplace(types, kernel);
        if (isNew || entry->second == kernel) continue;
        const Loc& other = entry->second->loc;
        return diagnostics.report(
            Diag::OverloadsAlike, kernel->loc,
            {kernel->name, fmt::format("{}:{}", module.sources[other.file], other.line), types});
      }
    }
  }
}

}  // namespace

void reportCppNames(const Module& module, Diagnostics& diagnostics) {
  const auto reportMacro = [&](const std::string& name, std::string_view kind, Loc loc) {
    if (isMacro(name)) diagnostics.report(Diag::NameIsMacro, loc, {name, kind});
  };
  for (const std::uint32_t index : usedStructs(module)) {
    const Struct& type = module.structs[index];
    if (type.isSynthesized || isShared(module, type)) continue;
    reportName(diagnostics, type.loc, "struct", type.name, cppName(module, type), type.scope.empty());
    for (const StructField& field : type.fields) reportMacro(field.name, "member", type.loc);
  }
  for (const BundleType& bundle : module.bundleTypes) {
    const std::string name = cppName(module, bundle);
    if (name != bundle.name)  // of an instance, with or without its arguments
      reportName(diagnostics, bundle.loc, "bundle", bundle.name + bundle.arguments, name,
                 bundle.scope.empty());
    for (const BundleMember& member : bundle.members) reportMacro(member.name, "member", bundle.loc);
  }
  for (const DeclaredStream& stream : module.streams) reportMacro(stream.name, "stream", stream.loc);
  for (const Callable& callable : callables(module)) {
    const Kernel& kernel = *overloadsOf(module, callable).front();
    for (const std::string& scope : kernel.scope) reportMacro(scope, "namespace", kernel.loc);
    reportName(diagnostics, kernel.loc, wordOf(kernel), kernel.name, callable.object, kernel.scope.empty());
  }
}

void reportOverloads(const Module& module, Diagnostics& diagnostics) {
  for (const Callable& callable : callables(module))
    reportAlike(module, overloadsOf(module, callable), diagnostics);
}

namespace {

// clang-format off: as many on a line as fit

/// <math.h>; each also with f and l at its end.
constexpr std::string_view mathFunctions[] = {
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "ceil", "copysign", "cos",
    "cosh", "drem", "erf", "erfc", "exp", "exp10", "exp2", "expm1", "fabs", "fdim", "finite", "floor",
    "fma", "fmax", "fmin", "fmod", "frexp", "gamma", "hypot", "ilogb", "isinf", "isnan", "j0", "j1",
    "jn", "ldexp", "lgamma", "llrint", "llround", "log", "log10", "log1p", "log2", "logb", "lrint",
    "lround", "modf", "nan", "nearbyint", "nextafter", "nexttoward", "pow", "remainder", "remquo",
    "rint", "round", "scalb", "scalbln", "scalbn", "significand", "sin", "sincos", "sinh", "sqrt",
    "tan", "tanh", "tgamma", "trunc", "y0", "y1", "yn"};

/// Functions, variables and types of the other headers of the C library, and namespaces.
constexpr std::string_view otherNames[] = {
    "FILE", "a64l", "abort", "abs", "access", "acct", "adjtime", "alarm", "aligned_alloc", "arc4random",
    "arc4random_buf", "arc4random_uniform", "asctime", "asctime_r", "asprintf", "atexit", "atof",
    "atoi", "atol", "atoll", "bcmp", "bcopy", "brk", "bsearch", "btowc", "bzero", "calloc",
    "canonicalize", "canonicalize_file_name", "chdir", "chmod", "chown", "chroot", "clearenv",
    "clearerr", "clearerr_unlocked", "clock", "clock_adjtime", "clock_getcpuclockid", "clock_getres",
    "clock_gettime", "clock_nanosleep", "clock_settime", "clone", "close", "close_range", "closefrom",
    "comparison_fn_t", "confstr", "cookie_close_function_t", "cookie_io_functions_t",
    "cookie_read_function_t", "cookie_seek_function_t", "cookie_write_function_t", "copy_file_range",
    "cpu_set_t", "creat", "creat64", "crypt", "ctermid", "ctime", "ctime_r", "cuserid", "daemon",
    "daylight", "difftime", "div", "div_t", "double_t", "dprintf", "drand48", "drand48_r", "dup",
    "dup2", "dup3", "duplocale", "dysize", "eaccess", "ecvt", "ecvt_r", "encrypt", "endusershell",
    "environ", "erand48", "erand48_r", "error_t", "euidaccess", "execl", "execle", "execlp", "execv",
    "execve", "execveat", "execvp", "execvpe", "exit", "explicit_bzero", "faccessat", "fchdir",
    "fchmod", "fchmodat", "fchown", "fchownat", "fclose", "fcloseall", "fcntl", "fcntl64", "fcvt",
    "fcvt_r", "fdatasync", "fdopen", "feof", "feof_unlocked", "ferror", "ferror_unlocked", "fexecve",
    "fflush", "fflush_unlocked", "ffs", "fgetc", "fgetc_unlocked", "fgetpos", "fgetpos64", "fgets",
    "fgets_unlocked", "fgetwc", "fgetwc_unlocked", "fgetws", "fgetws_unlocked", "fileno",
    "fileno_unlocked", "float_t", "flockfile", "fmaximum", "fmaximum_mag", "fmaximum_mag_num",
    "fmaximum_num", "fmaxmag", "fmemopen", "fminimum", "fminimum_mag", "fminimum_mag_num",
    "fminimum_num", "fminmag", "fopen", "fopen64", "fopencookie", "fork", "fpathconf", "fpos64_t",
    "fpos_t", "fpregset_t", "fprintf", "fputc", "fputc_unlocked", "fputs", "fputs_unlocked", "fputwc",
    "fputwc_unlocked", "fputws", "fputws_unlocked", "fread", "fread_unlocked", "free", "freelocale",
    "freopen", "freopen64", "fromfp", "fromfpx", "fscanf", "fseek", "fseeko", "fseeko64", "fsetpos",
    "fsetpos64", "fstat", "fstat64", "fstatat", "fstatat64", "fsync", "ftell", "ftello", "ftello64",
    "ftruncate", "ftruncate64", "ftrylockfile", "funlockfile", "futimens", "futimes", "futimesat",
    "fwide", "fwprintf", "fwrite", "fwrite_unlocked", "fwscanf", "gcvt", "get_current_dir_name", "getc",
    "getc_unlocked", "getchar", "getchar_unlocked", "getcpu", "getcwd", "getdate", "getdate_err",
    "getdate_r", "getdelim", "getdomainname", "getdtablesize", "getegid", "getentropy", "getenv",
    "geteuid", "getgid", "getgroups", "gethostid", "gethostname", "getitimer", "getline", "getloadavg",
    "getlogin", "getlogin_r", "getpagesize", "getpass", "getpayload", "getpgid", "getpgrp", "getpid",
    "getppid", "getpt", "getresgid", "getresuid", "getsid", "getsubopt", "gettid", "gettimeofday",
    "getuid", "getumask", "getusershell", "getw", "getwc", "getwc_unlocked", "getwchar",
    "getwchar_unlocked", "getwd", "gmtime", "gmtime_r", "grantpt", "greg_t", "gregset_t",
    "group_member", "gsignal", "imaxabs", "imaxdiv", "imaxdiv_t", "index", "initstate", "initstate_r",
    "int16_t", "int32_t", "int64_t", "int8_t", "int_fast16_t", "int_fast32_t", "int_fast64_t",
    "int_fast8_t", "int_least16_t", "int_least32_t", "int_least64_t", "int_least8_t", "intmax_t",
    "intptr_t", "isalnum", "isalnum_l", "isalpha", "isalpha_l", "isascii", "isatty", "isblank",
    "isblank_l", "iscntrl", "iscntrl_l", "isctype", "isdigit", "isdigit_l", "isgraph", "isgraph_l",
    "islower", "islower_l", "isprint", "isprint_l", "ispunct", "ispunct_l", "isspace", "isspace_l",
    "isupper", "isupper_l", "iswalnum", "iswalnum_l", "iswalpha", "iswalpha_l", "iswblank",
    "iswblank_l", "iswcntrl", "iswcntrl_l", "iswctype", "iswctype_l", "iswdigit", "iswdigit_l",
    "iswgraph", "iswgraph_l", "iswlower", "iswlower_l", "iswprint", "iswprint_l", "iswpunct",
    "iswpunct_l", "iswspace", "iswspace_l", "iswupper", "iswupper_l", "iswxdigit", "iswxdigit_l",
    "isxdigit", "isxdigit_l", "jmp_buf", "jrand48", "jrand48_r", "kill", "killpg", "l64a", "labs",
    "lchmod", "lchown", "lcong48", "lcong48_r", "ldiv", "ldiv_t", "link", "linkat", "llabs", "lldiv",
    "lldiv_t", "llogb", "locale_t", "localeconv", "localtime", "localtime_r", "lockf", "longjmp",
    "lrand48", "lrand48_r", "lseek", "lseek64", "lstat", "lstat64", "lutimes", "main", "malloc",
    "max_align_t", "mblen", "mbrlen", "mbrtowc", "mbsinit", "mbsnrtowcs", "mbsrtowcs", "mbstate_t",
    "mbstowcs", "mbtowc", "mcontext_t", "memccpy", "memchr", "memcmp", "memcpy", "memfrob", "memmem",
    "memmove", "mempcpy", "memset", "mkdir", "mkdirat", "mkdtemp", "mkfifo", "mkfifoat", "mknod",
    "mknodat", "mkostemp", "mkostemp64", "mkostemps", "mkostemps64", "mkstemp", "mkstemp64", "mkstemps",
    "mkstemps64", "mktemp", "mktime", "mrand48", "mrand48_r", "nanosleep", "newlocale", "nextdown",
    "nextup", "nice", "nrand48", "nrand48_r", "obstack_printf", "obstack_vprintf", "on_exit", "open",
    "open64", "open_memstream", "open_wmemstream", "openat", "openat64", "pathconf", "pause", "pclose",
    "perror", "pipe", "pipe2", "popen", "posix_fadvise", "posix_fadvise64", "posix_fallocate",
    "posix_fallocate64", "posix_memalign", "posix_openpt", "pread", "pread64", "printf", "profil",
    "program_invocation_name", "program_invocation_short_name", "psiginfo", "psignal", "ptrdiff_t",
    "ptsname", "ptsname_r", "putc", "putc_unlocked", "putchar", "putchar_unlocked", "putenv", "puts",
    "putw", "putwc", "putwc_unlocked", "putwchar", "putwchar_unlocked", "pwrite", "pwrite64", "qecvt",
    "qecvt_r", "qfcvt", "qfcvt_r", "qgcvt", "qsort", "qsort_r", "quick_exit", "raise", "rand", "rand_r",
    "random", "random_r", "read", "readlink", "readlinkat", "realloc", "reallocarray", "realpath",
    "remove", "rename", "renameat", "renameat2", "revoke", "rewind", "rindex", "rmdir", "roundeven",
    "rpmatch", "sbrk", "scanf", "sched_get_priority_max", "sched_get_priority_min", "sched_getaffinity",
    "sched_getcpu", "sched_getparam", "sched_getscheduler", "sched_rr_get_interval",
    "sched_setaffinity", "sched_setparam", "sched_setscheduler", "sched_yield", "secure_getenv",
    "seed48", "seed48_r", "select", "setbuf", "setbuffer", "setdomainname", "setegid", "setenv",
    "seteuid", "setgid", "sethostid", "sethostname", "setitimer", "setjmp", "setlinebuf", "setlocale",
    "setlogin", "setns", "setpayload", "setpayloadsig", "setpgid", "setpgrp", "setregid", "setresgid",
    "setresuid", "setreuid", "setsid", "setstate", "setstate_r", "settimeofday", "setuid",
    "setusershell", "setvbuf", "sig_atomic_t", "sig_t", "sigabbrev_np", "sigaction", "sigaddset",
    "sigaltstack", "sigandset", "sigblock", "sigdelset", "sigdescr_np", "sigemptyset", "sigevent_t",
    "sigfillset", "siggetmask", "sighandler_t", "sighold", "sigignore", "siginfo_t", "siginterrupt",
    "sigisemptyset", "sigismember", "sigjmp_buf", "siglongjmp", "signal", "signgam", "sigorset",
    "sigpause", "sigpending", "sigprocmask", "sigqueue", "sigrelse", "sigreturn", "sigset",
    "sigsetmask", "sigstack", "sigsuspend", "sigtimedwait", "sigval_t", "sigwait", "sigwaitinfo",
    "size_t", "sk", "sleep", "snprintf", "socklen_t", "sprintf", "srand", "srand48", "srand48_r",
    "srandom", "srandom_r", "sscanf", "ssignal", "stack_t", "stat", "stat64", "std", "stpcpy",
    "stpncpy", "strcat", "strchr", "strcmp", "strcoll", "strcoll_l", "strcpy", "strcspn", "strdup",
    "strerror", "strerror_l", "strerror_r", "strerrordesc_np", "strerrorname_np", "strfromd",
    "strfromf", "strfroml", "strfry", "strftime", "strftime_l", "strlen", "strncat", "strncmp",
    "strncpy", "strndup", "strnlen", "strptime", "strptime_l", "strsep", "strsignal", "strspn",
    "strstr", "strtod", "strtod_l", "strtof", "strtof32_l", "strtof32x_l", "strtof64_l", "strtof64x_l",
    "strtof_l", "strtoimax", "strtok", "strtok_r", "strtol", "strtol_l", "strtold", "strtold_l",
    "strtoll", "strtoll_l", "strtoq", "strtoul", "strtoul_l", "strtoull", "strtoull_l", "strtoumax",
    "strtouq", "strverscmp", "strxfrm", "strxfrm_l", "swab", "swprintf", "swscanf", "symlink",
    "symlinkat", "sync", "syncfs", "syscall", "sysconf", "system", "sysv_signal", "tcgetpgrp",
    "tcsetpgrp", "tempnam", "tgkill", "time", "timegm", "timelocal", "timer_create", "timer_delete",
    "timer_getoverrun", "timer_gettime", "timer_settime", "times", "timespec_get", "timespec_getres",
    "timezone", "tmpfile", "tmpfile64", "tmpnam", "tmpnam_r", "toascii", "tolower", "tolower_l",
    "totalorder", "totalordermag", "toupper", "toupper_l", "towctrans", "towctrans_l", "towlower",
    "towlower_l", "towupper", "towupper_l", "truncate", "truncate64", "ttyname", "ttyname_r", "ttyslot",
    "tzname", "tzset", "ualarm", "ucontext_t", "ufromfp", "ufromfpx", "uint16_t", "uint32_t",
    "uint64_t", "uint8_t", "uint_fast16_t", "uint_fast32_t", "uint_fast64_t", "uint_fast8_t",
    "uint_least16_t", "uint_least32_t", "uint_least64_t", "uint_least8_t", "uintmax_t", "uintptr_t",
    "umask", "ungetc", "ungetwc", "unlink", "unlinkat", "unlockpt", "unsetenv", "unshare", "uselocale",
    "usleep", "utimensat", "utimes", "va_list", "valloc", "vasprintf", "vdprintf", "vfork", "vfprintf",
    "vfscanf", "vfwprintf", "vfwscanf", "vhangup", "vprintf", "vscanf", "vsnprintf", "vsprintf",
    "vsscanf", "vswprintf", "vswscanf", "vwprintf", "vwscanf", "wait", "wcpcpy", "wcpncpy", "wcrtomb",
    "wcscasecmp", "wcscasecmp_l", "wcscat", "wcschr", "wcschrnul", "wcscmp", "wcscoll", "wcscoll_l",
    "wcscpy", "wcscspn", "wcsdup", "wcsftime", "wcsftime_l", "wcslen", "wcsncasecmp", "wcsncasecmp_l",
    "wcsncat", "wcsncmp", "wcsncpy", "wcsnlen", "wcsnrtombs", "wcspbrk", "wcsrchr", "wcsrtombs",
    "wcsspn", "wcsstr", "wcstod", "wcstod_l", "wcstof", "wcstof32_l", "wcstof32x_l", "wcstof64_l",
    "wcstof64x_l", "wcstof_l", "wcstoimax", "wcstok", "wcstol", "wcstol_l", "wcstold", "wcstold_l",
    "wcstoll", "wcstoll_l", "wcstombs", "wcstoq", "wcstoul", "wcstoul_l", "wcstoull", "wcstoull_l",
    "wcstoumax", "wcstouq", "wcswcs", "wcswidth", "wcsxfrm", "wcsxfrm_l", "wctob", "wctomb", "wctrans",
    "wctrans_l", "wctrans_t", "wctype", "wctype_l", "wctype_t", "wcwidth", "wint_t", "wmemchr",
    "wmemcmp", "wmemcpy", "wmemmove", "wmempcpy", "wmemset", "wprintf", "write", "wscanf"};

/// Structs of the C library: a variable or function may have the same name in C++, another struct may not.
constexpr std::string_view tags[] = {
    "drand48_data", "f_owner_ex", "file_handle", "flock", "flock64", "iovec", "itimerspec", "itimerval",
    "lconv", "obstack", "random_data", "sched_param", "sigcontext", "sigevent", "sigval", "statx",
    "statx_timestamp", "timex", "tm"};

/// Macros, and the keywords that GNU C++ adds.
constexpr std::string_view macros[] = {
    "BIG_ENDIAN", "BUFSIZ", "BYTE_ORDER", "CHAR_BIT", "CHAR_MAX", "CHAR_MIN", "CLOCKS_PER_SEC",
    "DBL_EPSILON", "DBL_MAX", "DBL_MIN", "E2BIG", "EACCES", "EADDRINUSE", "EADDRNOTAVAIL", "EADV",
    "EAFNOSUPPORT", "EAGAIN", "EALREADY", "EBADE", "EBADF", "EBADFD", "EBADMSG", "EBADR", "EBADRQC",
    "EBADSLT", "EBFONT", "EBUSY", "ECANCELED", "ECHILD", "ECHRNG", "ECOMM", "ECONNABORTED",
    "ECONNREFUSED", "ECONNRESET", "EDEADLK", "EDEADLOCK", "EDESTADDRREQ", "EDOM", "EDOTDOT", "EDQUOT",
    "EEXIST", "EFAULT", "EFBIG", "EHOSTDOWN", "EHOSTUNREACH", "EHWPOISON", "EIDRM", "EILSEQ",
    "EINPROGRESS", "EINTR", "EINVAL", "EIO", "EISCONN", "EISDIR", "EISNAM", "EKEYEXPIRED",
    "EKEYREJECTED", "EKEYREVOKED", "EL2HLT", "EL2NSYNC", "EL3HLT", "EL3RST", "ELIBACC", "ELIBBAD",
    "ELIBEXEC", "ELIBMAX", "ELIBSCN", "ELNRNG", "ELOOP", "EMEDIUMTYPE", "EMFILE", "EMLINK", "EMSGSIZE",
    "EMULTIHOP", "ENAMETOOLONG", "ENAVAIL", "ENETDOWN", "ENETRESET", "ENETUNREACH", "ENFILE", "ENOANO",
    "ENOBUFS", "ENOCSI", "ENODATA", "ENODEV", "ENOENT", "ENOEXEC", "ENOKEY", "ENOLCK", "ENOLINK",
    "ENOMEDIUM", "ENOMEM", "ENOMSG", "ENONET", "ENOPKG", "ENOPROTOOPT", "ENOSPC", "ENOSR", "ENOSTR",
    "ENOSYS", "ENOTBLK", "ENOTCONN", "ENOTDIR", "ENOTEMPTY", "ENOTNAM", "ENOTRECOVERABLE", "ENOTSOCK",
    "ENOTSUP", "ENOTTY", "ENOTUNIQ", "ENXIO", "EOF", "EOPNOTSUPP", "EOVERFLOW", "EOWNERDEAD", "EPERM",
    "EPFNOSUPPORT", "EPIPE", "EPROTO", "EPROTONOSUPPORT", "EPROTOTYPE", "ERANGE", "EREMCHG", "EREMOTE",
    "EREMOTEIO", "ERESTART", "ERFKILL", "EROFS", "ESHUTDOWN", "ESOCKTNOSUPPORT", "ESPIPE", "ESRCH",
    "ESRMNT", "ESTALE", "ESTRPIPE", "ETIME", "ETIMEDOUT", "ETOOMANYREFS", "ETXTBSY", "EUCLEAN",
    "EUNATCH", "EUSERS", "EWOULDBLOCK", "EXDEV", "EXFULL", "EXIT_FAILURE", "EXIT_SUCCESS", "FD_CLR",
    "FD_ISSET", "FD_SET", "FD_SETSIZE", "FD_ZERO", "FILENAME_MAX", "FLT_EPSILON", "FLT_MAX", "FLT_MIN",
    "FOPEN_MAX", "HUGE_VAL", "HUGE_VALF", "HUGE_VALL", "INFINITY", "INT16_C", "INT16_MAX", "INT16_MIN",
    "INT16_WIDTH", "INT32_C", "INT32_MAX", "INT32_MIN", "INT32_WIDTH", "INT64_C", "INT64_MAX",
    "INT64_MIN", "INT64_WIDTH", "INT8_C", "INT8_MAX", "INT8_MIN", "INT8_WIDTH", "INTMAX_C",
    "INTMAX_MAX", "INTMAX_MIN", "INTMAX_WIDTH", "INTPTR_MAX", "INTPTR_MIN", "INTPTR_WIDTH",
    "INT_FAST16_MAX", "INT_FAST16_MIN", "INT_FAST16_WIDTH", "INT_FAST32_MAX", "INT_FAST32_MIN",
    "INT_FAST32_WIDTH", "INT_FAST64_MAX", "INT_FAST64_MIN", "INT_FAST64_WIDTH", "INT_FAST8_MAX",
    "INT_FAST8_MIN", "INT_FAST8_WIDTH", "INT_LEAST16_MAX", "INT_LEAST16_MIN", "INT_LEAST16_WIDTH",
    "INT_LEAST32_MAX", "INT_LEAST32_MIN", "INT_LEAST32_WIDTH", "INT_LEAST64_MAX", "INT_LEAST64_MIN",
    "INT_LEAST64_WIDTH", "INT_LEAST8_MAX", "INT_LEAST8_MIN", "INT_LEAST8_WIDTH", "INT_MAX", "INT_MIN",
    "LC_ADDRESS", "LC_ADDRESS_MASK", "LC_ALL", "LC_ALL_MASK", "LC_COLLATE", "LC_COLLATE_MASK",
    "LC_CTYPE", "LC_CTYPE_MASK", "LC_GLOBAL_LOCALE", "LC_IDENTIFICATION", "LC_IDENTIFICATION_MASK",
    "LC_MEASUREMENT", "LC_MEASUREMENT_MASK", "LC_MESSAGES", "LC_MESSAGES_MASK", "LC_MONETARY",
    "LC_MONETARY_MASK", "LC_NAME", "LC_NAME_MASK", "LC_NUMERIC", "LC_NUMERIC_MASK", "LC_PAPER",
    "LC_PAPER_MASK", "LC_TELEPHONE", "LC_TELEPHONE_MASK", "LC_TIME", "LC_TIME_MASK", "LITTLE_ENDIAN",
    "LLONG_MAX", "LLONG_MIN", "LONG_MAX", "LONG_MIN", "L_ctermid", "L_cuserid", "L_tmpnam",
    "MB_CUR_MAX", "M_E", "M_PI", "NAN", "NFDBITS", "NULL", "PDP_ENDIAN", "PTRDIFF_MAX", "PTRDIFF_MIN",
    "PTRDIFF_WIDTH", "P_tmpdir", "RAND_MAX", "RENAME_EXCHANGE", "RENAME_NOREPLACE", "RENAME_WHITEOUT",
    "SEEK_CUR", "SEEK_DATA", "SEEK_END", "SEEK_HOLE", "SEEK_SET", "SHRT_MAX", "SHRT_MIN",
    "SIG_ATOMIC_MAX", "SIG_ATOMIC_MIN", "SIG_ATOMIC_WIDTH", "SIZE_MAX", "SIZE_WIDTH", "TMP_MAX",
    "UINT16_C", "UINT16_MAX", "UINT16_WIDTH", "UINT32_C", "UINT32_MAX", "UINT32_WIDTH", "UINT64_C",
    "UINT64_MAX", "UINT64_WIDTH", "UINT8_C", "UINT8_MAX", "UINT8_WIDTH", "UINTMAX_C", "UINTMAX_MAX",
    "UINTMAX_WIDTH", "UINTPTR_MAX", "UINTPTR_WIDTH", "UINT_FAST16_MAX", "UINT_FAST16_WIDTH",
    "UINT_FAST32_MAX", "UINT_FAST32_WIDTH", "UINT_FAST64_MAX", "UINT_FAST64_WIDTH", "UINT_FAST8_MAX",
    "UINT_FAST8_WIDTH", "UINT_LEAST16_MAX", "UINT_LEAST16_WIDTH", "UINT_LEAST32_MAX",
    "UINT_LEAST32_WIDTH", "UINT_LEAST64_MAX", "UINT_LEAST64_WIDTH", "UINT_LEAST8_MAX",
    "UINT_LEAST8_WIDTH", "UINT_MAX", "ULLONG_MAX", "ULONG_MAX", "USHRT_MAX", "WCHAR_MAX", "WCHAR_MIN",
    "WCHAR_WIDTH", "WCONTINUED", "WEOF", "WEXITED", "WEXITSTATUS", "WIFCONTINUED", "WIFEXITED",
    "WIFSIGNALED", "WIFSTOPPED", "WINT_MAX", "WINT_MIN", "WINT_WIDTH", "WNOHANG", "WNOWAIT", "WSTOPPED",
    "WSTOPSIG", "WTERMSIG", "WUNTRACED", "alloca", "assert", "be16toh", "be32toh", "be64toh", "errno",
    "htobe16", "htobe32", "htobe64", "htole16", "htole32", "htole64", "le16toh", "le32toh", "le64toh",
    "linux", "offsetof", "stderr", "stdin", "stdout", "typeof", "unix"};

// clang-format on

static_assert(std::ranges::is_sorted(mathFunctions) && std::ranges::is_sorted(otherNames) &&
                  std::ranges::is_sorted(tags) && std::ranges::is_sorted(macros),
              "for binary search");

template <class Table>
bool contains(const Table& table, std::string_view name) {
  return std::binary_search(std::begin(table), std::end(table), name);
}

}  // namespace

bool isGlobalCName(std::string_view name) {
  if (name.starts_with("pthread_") || contains(otherNames, name) || contains(mathFunctions, name))
    return true;
  const bool hasSuffix = !name.empty() && (name.back() == 'f' || name.back() == 'l');
  return hasSuffix && contains(mathFunctions, name.substr(0, name.size() - 1));
}

bool isCTag(std::string_view name) { return contains(tags, name); }

bool isMacro(std::string_view name) { return contains(macros, name); }

}  // namespace skc::emit
