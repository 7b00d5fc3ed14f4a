// SPDX-License-Identifier: MIT

/** What went wrong, for programs that handle some errors differently from others. */
export type ErrorKind =
  | 'device' // there is no such device, or it cannot do what is requested
  | 'shape' // shapes, extents or ranks that do not match or are too large
  | 'type' // a stream whose element type is not the parameter's, or an array of another type
  | 'memory' // out of memory on the device
  | 'compile' // the driver rejects a program, or skc has not assembled it
  | 'lost' // a context or stream that has ended
  | 'misuse'; // any other misuse

/** The error of every call of this package. The message says what is wrong and what to do. */
export class SkError extends Error {
  constructor(message: string, readonly kind: ErrorKind = 'misuse') {
    super(message);
    this.name = 'SkError';
  }
}
