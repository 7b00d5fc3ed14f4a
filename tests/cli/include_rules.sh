#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Checks what no compiler does: which folder includes which, who sees Clang and GL, that every source
# names its license, and that no file is too long. Usage: include_rules.sh [ROOT]. Prints each finding as
# FILE:LINE: what is wrong; status 1 where there is one.
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}"

# Folder: which folders and files it may include, of those that begin with a guarded name. The innermost folder with a
# rule counts.
rules='
compiler/support      support
compiler/ir           support ir
compiler/analysis     support ir analysis
compiler/split        support ir split
compiler/bounds       support ir bounds sk/error_bounds.hpp sk/options.hpp sk/sum_bounds.hpp
compiler/transforms   support ir analysis transforms split sk/exact_digits.hpp
compiler/native       support ir analysis transforms native llvm sk/native/code.hpp sk/native/table.hpp
compiler/native/library support ir transforms native
compiler/glsl         support ir analysis glsl sk/program.hpp sk/arithmetic_marks.hpp
compiler/program      support ir analysis native/kernel_request.hpp split/cost.hpp glsl program assemble sk/program.hpp sk/scalar_bytes.hpp
compiler/web          support ir glsl program assemble web sk/program.hpp
compiler/frontend     support ir frontend clang llvm
compiler/driver       support ir bounds analysis split transforms native/native.hpp native/library/link_library.hpp glsl program web frontend driver assemble sk/program.hpp
runtime/include/sk    sk
runtime/src/support   sk support
runtime/src/trace     sk support trace
runtime/src/device    sk toml trace device gl/known_devices.hpp call/resolved_call.hpp call/row_pieces.hpp native/native_device.hpp native/native_stream.hpp assemble/glsl/tables.hpp assemble/nearest_word.hpp
runtime/src/call      sk support device call assemble
runtime/src/domain    sk domain
runtime/src/results   sk support device results
runtime/src/api       sk support trace device call results api assemble gl_device/gl_device.hpp native/native_device.hpp probe/probe.hpp shadow/shadow_device.hpp
runtime/src/native    sk support trace device call native assemble probe/copy_bandwidth.hpp
runtime/src/probe     sk support trace device call gl gl_device probe assemble
runtime/src/gl        sk gl epoxy EGL GL GLES3
runtime/src/toml      toml
runtime/src/shadow    sk support trace device call native shadow shadow_text assemble/nearest_word.hpp
runtime/src/gl_device sk support trace device call probe gl gl_device assemble
runtime/src/gl_device/memory sk gl gl_device/memory device/region.hpp assemble
runtime/src/assemble  sk/program.hpp sk/arithmetic.hpp sk/limits.hpp sk/scalar_bytes.hpp assemble
runtime/src/assemble/glsl     sk/program.hpp sk/arithmetic.hpp sk/limits.hpp ASSEMBLE assemble/glsl
runtime/src/assemble/elements sk/program.hpp sk/arithmetic_marks.hpp sk/scalar_bytes.hpp ASSEMBLE assemble/glsl assemble/elements
runtime/src/assemble/append   sk/program.hpp sk/scalar_bytes.hpp ASSEMBLE assemble/glsl assemble/elements assemble/append
runtime/src/assemble/reduce   sk/program.hpp sk/exact_digits.hpp sk/types.hpp sk/limits.hpp sk/scalar_bytes.hpp ASSEMBLE assemble/glsl assemble/elements assemble/reduce assemble/program/sample_kernels.hpp
runtime/mpi           sk support device call api native gl assemble
runtime/text          sk text
runtime/linear        sk text
runtime/tools         sk support/cache_folder.hpp support/npz.hpp support/process_name.hpp text/real_option.hpp native probe/probe.hpp assemble/nearest_word.hpp shadow
runtime/tools/sk/tune sk support/cache_folder.hpp support/process_name.hpp text/real_option.hpp assemble/nearest_word.hpp results/results_file.hpp toml/read_toml.hpp
runtime/tests         sk support trace device call gl gl_device native assemble epoxy
examples              sk toml text linear/grid_stream.hpp epoxy
tests                 sk
tests/bench           sk epoxy support/named.hpp
tests/numerics/fpbench sk bounds driver ir support/devices.hpp
tests/docs            sk support/diagnostics.def ir/intrinsics.def
tests/docs            support ir
tests/faults          sk epoxy
tests/mpi             sk support device/stream_state.hpp
tests/fuzz            sk ir program driver analysis transforms native/native.hpp device/configuration.hpp support/cache_folder.hpp support/function_oracle.hpp support/oracle.hpp support/image.hpp
'
# What all rooms of the assembler share.
rules=${rules//ASSEMBLE/assemble/assemble.hpp assemble/condition.hpp assemble/region_layout.hpp assemble/relayed_values.hpp}
guarded='support|ir|bounds|analysis|split|transforms|native|glsl|program|frontend|driver|sk|trace|device|call|results|api|probe|gl|toml|text|linear|gl_device|assemble|shadow|shadow_text|clang|clang-c|llvm|llvm-c|epoxy|EGL|GL|GLES2|GLES3|KHR'
longest=600

roots=(compiler runtime examples tests)

# Our own texts; goldens and other files of tests are data.
sources() { find "${roots[@]}" "$@" -type f | LC_ALL=C sort; }

includes() {
  sources '(' -name '*.hpp' -o -name '*.cpp' -o -name '*.def' ')' |
    xargs -r awk -v rules="$rules" -v guarded="^($guarded)\$" '
      BEGIN {
        count = split(rules, lines, "\n")
        for (i = 1; i <= count; ++i) {
          n = split(lines[i], words, " ")
          for (j = 2; j <= n; ++j) may[words[1], words[j]] = 1
          if (n) folders[words[1]] = 1
        }
      }
      function isAllowed(folder, name) {
        do if ((folder, name) in may) return 1
        while (sub("/[^/]*$", "", name))
        return 0
      }
      function folderOf(file, folder) {
        for (folder = file; sub("/[^/]*$", "", folder);) if (folder in folders) return folder
        return ""
      }
      # Generated code that a test expects, in a raw string, includes nothing here.
      FNR == 1 { raw = "" }
      raw != "" { if (index($0, raw)) raw = ""; next }
      match($0, /R"[a-z]*\(/) {
        end = ")" substr($0, RSTART + 2, RLENGTH - 3) "\""
        if (!index(substr($0, RSTART + RLENGTH), end)) raw = end
        next
      }
      /^[ \t]*#[ \t]*include[ \t]*[<"]/ {
        name = $0
        sub(/^[^<"]*[<"]/, "", name)
        sub(/[>"].*$/, "", name)
        top = name
        if (!sub("/.*$", "", top)) next
        folder = folderOf(FILENAME)
        # examples/support and the like: folders of their own that bear a guarded name.
        if (folder ~ /^(examples|tests)$/ && top ~ /^(support|trace)$/) next
        if (top ~ guarded && !isAllowed(folder, name))
          printf "%s:%d: %s may not include %s\n", FILENAME, FNR, folder, name
      }'
}

license() {
  { sources '(' -name '*.hpp' -o -name '*.cpp' -o -name '*.def' -o -name '*.cmake' -o -name '*.sh' \
      -o -name '*.glsl' \
      -o -name 'CMakeLists.txt' ')'
    sources -path 'examples/*.sk'
    find CMakeLists.txt dev cmake .ci -type f
  } | xargs -r awk 'FNR <= 2 && /SPDX-License-Identifier: MIT/ { named[FILENAME] = 1 }
                    END { for (i = 1; i < ARGC; ++i)
                            if (!(ARGV[i] in named)) printf "%s:1: no SPDX-License-Identifier: MIT\n", ARGV[i] }'
}

lengths() {
  sources '(' -name '*.hpp' -o -name '*.cpp' -o -name '*.def' -o -name '*.sk' ')' -not -path 'tests/*/cases/*' |
    xargs -r awk -v longest="$longest" 'FNR == longest + 1 { printf "%s:%d: longer than %d lines\n", FILENAME, FNR, longest }'
}

findings=$(includes; license; lengths)
if [[ -n $findings ]]; then
  printf '%s\n' "$findings"
  exit 1
fi
echo "include rules, licenses and lengths hold in $(sources -name '*.[hc]pp' | wc -l) sources"
