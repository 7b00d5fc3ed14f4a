#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Proves that include_rules.sh can fail: a small tree that breaks each rule once, and what it must say.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cd "$tree"

# put FILE LINE...: a source with these lines.
put() {
  local file=$1
  shift
  mkdir -p "$(dirname "$file")"
  printf '%s\n' "$@" >"$file"
}
licensed='// SPDX-License-Identifier: MIT'

put CMakeLists.txt '# SPDX-License-Identifier: MIT'
put dev '#!/bin/sh' '# SPDX-License-Identifier: MIT'
mkdir -p cmake .ci
put compiler/ir/good.hpp "$licensed" '#include <vector>' '#include "ir/type.hpp"' '#include "support/loc.hpp"'
put runtime/src/gl/good.cpp "$licensed" '#include <epoxy/gl.h>' '#include "sk/stream.hpp"'
put runtime/src/assemble/good.cpp "$licensed" '#include "sk/program.hpp"'
put examples/hello/good.cpp "$licensed" '#include <sk/sk.hpp>' '#include "support/table.hpp"'
put compiler/program/good_test.cpp "$licensed" 'text = R"(a stub:' '#include "sk/call.hpp"' ')";' 'inline = R"(x)";'
put tests/run/good.cpp "$licensed" '#include "good.sk.hpp"'

output=$("$here/include_rules.sh" .) || { echo "a good tree is refused: $output"; exit 1; }

put compiler/ir/a.hpp "$licensed" '#include "transforms/transforms.hpp"'
put compiler/program/b.cpp "$licensed" '#include <vector>' '#include <clang/AST/Decl.h>'
put compiler/program/raw.cpp "$licensed" 'c = R"x(' '#include "sk/sk.hpp" )"' ')x";' '#include "frontend/frontend.hpp"'
put compiler/driver/c.cpp "$licensed" '#  include "llvm/Support/raw_ostream.h"'
put compiler/frontend/d.cpp "$licensed" '#include "program/stub.hpp"'
put compiler/program/e.cpp "$licensed" '#include "sk/stream.hpp"'
put runtime/src/call/f.cpp "$licensed" '#include <epoxy/egl.h>'
put runtime/src/assemble/g.cpp "$licensed" '#include "sk/stream.hpp"'
put runtime/src/assemble/glsl/l.cpp "$licensed" '#include "assemble/reduce/reduce_plan.hpp"' '#include "assemble/assemble.hpp"'
put runtime/src/gl/h.cpp "$licensed" '#include "ir/ir.hpp"'
put examples/hello/i.cpp "$licensed" '#include <GL/gl.h>'
put tests/run/j.cpp 'int unlicensed;'
mapfile -t lines < <(seq 600)
put runtime/src/k.cpp "$licensed" "${lines[@]/#/// }"

expected='compiler/driver/c.cpp:2: compiler/driver may not include llvm/Support/raw_ostream.h
compiler/frontend/d.cpp:2: compiler/frontend may not include program/stub.hpp
compiler/ir/a.hpp:2: compiler/ir may not include transforms/transforms.hpp
compiler/program/b.cpp:3: compiler/program may not include clang/AST/Decl.h
compiler/program/e.cpp:2: compiler/program may not include sk/stream.hpp
compiler/program/raw.cpp:5: compiler/program may not include frontend/frontend.hpp
examples/hello/i.cpp:2: examples may not include GL/gl.h
runtime/src/assemble/g.cpp:2: runtime/src/assemble may not include sk/stream.hpp
runtime/src/assemble/glsl/l.cpp:2: runtime/src/assemble/glsl may not include assemble/reduce/reduce_plan.hpp
runtime/src/call/f.cpp:2: runtime/src/call may not include epoxy/egl.h
runtime/src/gl/h.cpp:2: runtime/src/gl may not include ir/ir.hpp
runtime/src/k.cpp:601: longer than 600 lines
tests/run/j.cpp:1: no SPDX-License-Identifier: MIT'

if output=$("$here/include_rules.sh" .); then
  echo "a bad tree is accepted: $output"
  exit 1
fi
diff <(printf '%s\n' "$expected") <(printf '%s\n' "$output" | LC_ALL=C sort)
