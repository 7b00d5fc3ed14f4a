// SPDX-License-Identifier: MIT
//
// A program as the fragment of an address, which browsers send to nobody: JSON, deflated, in base64 for addresses.
const prefix = '#p=';
const mostCharacters = 256 << 10; // of a program, as the server takes

async function through(stream, bytes) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

/** The fragment for a state, any value of JSON. */
export async function fragmentOf(state) {
  const bytes = await through(new CompressionStream('deflate-raw'), new TextEncoder().encode(JSON.stringify(state)));
  const characters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('');
  return prefix + btoa(characters).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
}

/** Decompresses at most so many bytes: a short link may hold a long text of one letter. */
async function inflated(bytes, most) {
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw')).getReader();
  const parts = [];
  let length = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    length += value.length;
    if (length > most) throw new Error('its program is too long');
    parts.push(value);
  }
  return new Blob(parts).text();
}

/** The state in a fragment; null if it holds none. Throws an Error that says why a link is broken. */
export async function stateOf(fragment) {
  if (!fragment.startsWith(prefix)) return null;
  try {
    const characters = atob(fragment.slice(prefix.length).replace(/-/g, '+').replace(/_/g, '/'));
    const state = JSON.parse(await inflated(Uint8Array.from(characters, (one) => one.charCodeAt(0)), 4 * mostCharacters));
    if (typeof state?.text !== 'string') throw new Error('it holds no program');
    return state;
  } catch (error) {
    throw new Error(`the link is broken: ${error.message}`);
  }
}
