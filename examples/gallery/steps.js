// SPDX-License-Identifier: MIT
//
// What accuracy tables of simulations share: each way to compute makes some steps of a small field, which JavaScript's doubles check, and is timed
// on streams as large as those of the picture.
import { relativeError } from './accuracy.js';

/**
 * Rows of the table. `ways`: [choice, prepare] pairs; prepare(streams) returns what a step does. `small` and `large` make the streams of a way;
 * `result` reads what is compared with `exact`.
 */
export async function* compareSteps({ time }, { ways, steps, note, small, large, result, exact, errorOf = relativeError }) {
  for (const [choice, prepare] of ways) {
    const [few, many] = [small(), large()];
    const step = prepare(few);
    for (let i = 0; i < steps; ++i) step();
    const error = errorOf(await result(few), exact);
    yield { choice, note, ms: await time(prepare(many)), error };
    for (const stream of [...Object.values(few), ...Object.values(many)]) stream.dispose();
  }
}
