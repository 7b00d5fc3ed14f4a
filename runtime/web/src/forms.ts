// SPDX-License-Identifier: MIT
//
// The programs of a kernel or reduce for a call's choice of precision and intrinsics.
import { fail } from './arguments.js';
import type { Dials, GeneratedFile, WithForms } from './generated.js';

const known = { precision: ['half', 'single', 'extended'], intrinsics: ['accurate', 'fast'] } as const;

/**
 * What to run in place of `usual`, the form in single precision with accurate intrinsics. Throws SkError, kind 'compile', if
 * skc has not assembled it.
 */
export function formOf<Data extends WithForms<Data>>(usual: Data, file: GeneratedFile, options: Dials): Data {
  const { name } = usual;
  for (const dial of ['precision', 'intrinsics'] as const) {
    const wanted = options[dial];
    if (wanted !== undefined && !(known[dial] as readonly string[]).includes(wanted)) {
      fail(name, `there is no ${dial} '${wanted}'; there are ${known[dial].join(', ')}`);
    }
  }
  const precision = options.precision ?? usual.precision ?? 'single';
  const isFast = (options.intrinsics ?? usual.intrinsics) === 'fast';
  const words = [...(precision === 'single' ? [] : [precision]), ...(isFast ? ['fast'] : [])];
  if (words.length === 0) return usual;
  const form = usual.forms?.[words.join(' ')];
  if (form === null) return usual; // it computes no floats, or calls no intrinsics
  if (form === undefined) fail(name, `${file.name}.js has no programs for ${words.join(' and ')}; write [[variants(${words.join(', ')})]] before '${name}' in ${file.name}`, 'compile');
  if ('whyNot' in form) fail(name, `it has no form in ${precision} precision: ${form.whyNot}; call it in single precision`, 'compile');
  return form as Data;
}

/** One caller for each form that is called. */
export class Forms<Data extends WithForms<Data>, Caller> {
  private readonly callers = new Map<Data, Caller>();

  constructor(private readonly usual: Data, private readonly file: GeneratedFile, private readonly make: (form: Data) => Caller) {}

  of(options: Dials): Caller {
    const form = formOf(this.usual, this.file, options);
    let caller = this.callers.get(form);
    if (caller === undefined) this.callers.set(form, (caller = this.make(form)));
    return caller;
  }
}
