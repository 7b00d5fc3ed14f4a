// SPDX-License-Identifier: MIT
//
// Pictures that take a while: each is drawn to its end, and the last one shows what there is then.

/** A function that calls `work`, which returns a promise. While that is on its way, calls are put off, and become one call after it. */
export function oneAtATime(work) {
  let current = Promise.resolve();
  let next = null;
  return () => {
    next ??= current.catch(() => {}).then(() => {
      next = null;
      current = work();
      return current;
    });
    return next;
  };
}
