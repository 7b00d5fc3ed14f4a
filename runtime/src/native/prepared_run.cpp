// SPDX-License-Identifier: MIT
#include "native/prepared_run.hpp"

#include "native/native_pass.hpp"

namespace sk {

void PreparedRun::run() {
  operands_.beginAgain();
  WriteScope writes(operands_.writtenInPlace());
  {
    const NativePass traced(device_, kernel_, {}, resolved_.arguments, resolved_.domain);
    code_.run(call_);
  }
  operands_.settleAgain();
  writes.commit();
}

}  // namespace sk
