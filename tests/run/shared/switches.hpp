// SPDX-License-Identifier: MIT
//
// The switches that control_flow.hpp lists. The text is both a .sk file and C++.
namespace control {

inline int switchPlain(int x, int y) {
  int r;
  switch (x) {
    case 0: r = y; break;
    case 1: r = y + 1; break;
    case 7: r = y * y; break;
    default: r = -1; break;
  }
  return r;
}

inline int switchFallthrough(int x, int y) {
  int r = 0;
  switch (x) {
    case 3: r += 3; [[fallthrough]];
    case 2: r += 20; [[fallthrough]];
    case 1: r += y; break;
    case 5: r = 5; [[fallthrough]];
    default: r += 1000;
  }
  return r;
}

inline int switchSharedLabels(int x, int y) {
  switch (x) {
    case 1:
    case 2:
    case 3: return 10 + y;
    case 4:
    default:
    case 6: return 20 + y;
    case 7:
    case -1: return 30 + y;
  }
}

inline int switchNoDefault(int x, int y) {
  int r = y;
  switch (x) {
    case 2: r = 1; break;
    case 4: r = 2; break;
  }
  return r;
}

inline int switchDefaultFirst(int x, int y) {
  int r = 0;
  switch (x) {
    default: r = 9; break;
    case 1: r = y;
  }
  return r;
}

inline int switchDefaultInMiddle(int x, int y) {
  int r = 0;
  switch (x) {
    case 1: r = 1; break;
    default: r = y; break;
    case 2: r = 2; break;
  }
  return r;
}

inline int switchDefaultFalls(int x, int y) {
  int r = 0;
  switch (x) {
    case 1: r += 1; [[fallthrough]];
    default: r += y; [[fallthrough]];
    case 2: r += 200; break;
    case 3: r = 3;
  }
  return r;
}

inline int switchEmptyLast(int x, int y) {
  int r = y;
  switch (x) {
    case 0: r = 1; break;
    case 1: break;
    default:;
  }
  switch (y) {
    case 0: {
    }
  }
  return r;
}

inline int switchOnlyDefault(int x, int y) {
  int r = x;
  switch (y) {
    default: r += 3;
  }
  return r;
}

inline int switchNoCases(int x, int y) {
  int i = x;
  switch (i++) {}
  return i + y;
}

inline int switchUnsigned(int x, int y) {
  unsigned u = static_cast<unsigned>(x);
  switch (u) {
    case 0: return 1;
    case 0xffffffffu: return 2;
    case 3u: return y;
    default: return 4;
  }
}

inline int switchNegative(int x, int y) {
  switch (x) {
    case -5: return 1;
    case -1: return y;
    case +1: return 3;
    default: return 0;
  }
}

inline int switchOnExpression(int x, int y) {
  int r = 0;
  switch ((x + y) & 3) {
    case 0: r = 4; break;
    case 1: r = 3; break;
    case 2: r = 2; break;
    case 3: r = 1; break;
  }
  switch (x++ - y) {
    case 0: r += 100; break;
    case 1: r += x;
  }
  return r;
}

inline int switchOnBool(int x, int y) {
  switch (int(x < y)) {
    case true: return 1;
    case false: return 2;
  }
  return 3;
}

inline int switchDeclarations(int x, int y) {
  int r = 0;
  switch (x) {
    case 0: {
      int t = y * 2;
      r = t;
      break;
    }
    case 1: {
      int t = y * 3;
      r = t + 1;
    }
      [[fallthrough]];
    case 2:
      int late;
      late = y + 5;
      r += late;
      break;
    case 3: late = 4; r = late;
  }
  return r;
}

inline int switchInLoopBreak(int x, int y) {
  int r = 0;
  for (int i = 0; i < 6; ++i) {
    switch (i) {
      case 1: break;                       // of the switch
      case 3: r += x; [[fallthrough]];
      case 4: r += y; break;
      default: ++r;
    }
    r *= 2;
  }
  return r;
}

inline int switchInLoopContinue(int x, int y) {
  int r = 0, i = 0;
  while (i++ < 8) {
    switch ((i + x) & 3) {
      case 0: continue;                    // of the loop
      case 1: r += 5; break;
      case 2:
        if (y > i) continue;
        r += 50;
    }
    r += 1000;
  }
  return r;
}

inline int loopInSwitch(int x, int y) {
  int r = 0;
  switch (x & 1) {
    case 0:
      for (int i = 0; i < 5; ++i) {
        if (i == y) break;                 // of the loop
        r += i;
      }
      r += 100;
      break;
    default: do { r += 3;
      } while (r < y);
  }
  return r;
}

inline int switchInSwitch(int x, int y) {
  int r = 0;
  switch (x) {
    case 1:
      switch (y) {
        case 1: r = 11; break;
        case 2: r = 12; [[fallthrough]];
        default: r += 1;
      }
      r += 100;
      break;
    case 2: r = 2; break;
    default:
      switch (y) {
        case 5: return 5;
      }
  }
  return r;
}

inline int switchBreakInIf(int x, int y) {
  int r = 0;
  switch (x) {
    case 2:
      if (y > 2) break;
      r = 1;
      {
        if (y == 1) break;
        r = 2;
      }
      [[fallthrough]];
    case 3:
      r += 10;
      if (y == 0) {
        r += 5;
        break;
      } else {
        r += 6;
      }
      r += 100;
  }
  return r;
}

inline int continueInNestedSwitches(int x, int y) {
  int r = 0, i = 0;
  do {
    ++i;
    switch (x & 3) {
      case 0:
        switch (y & 3) {
          case 1:
            if (i == 2) continue;
            r += 1;
            break;
          default:
            switch (i) {
              case 1: r += 3; [[fallthrough]];
              case 3:
                if (x < y) continue;
                [[fallthrough]];
              default: r += 7;
            }
            r += 13;
        }
        r += 10;
        break;
      case 1: r += 100; break;
    }
    r += 1000;
  } while (i < 3);
  return r;
}

inline int continueForFromNestedSwitches(int x, int y) {
  int r = 0;
  for (int i = 0; i < 4; i += 1 + (y & 1)) {
    switch (x & 1) {
      case 0:
        switch (y & 1) {
          default:
            if (x < 4) continue;
            r += 1;
        }
        r += 10;
    }
    while (r % 7 != 0) {
      ++r;
      switch (x) {
        case 2: continue;
        case 3:
          switch (y) {
            case 1: break;
            default: continue;
          }
          r += 2;
      }
      r += 3;
    }
    r += 1000;
  }
  return r;
}

}  // namespace control
