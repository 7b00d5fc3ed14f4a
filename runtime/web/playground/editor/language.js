// SPDX-License-Identifier: MIT
//
// Colours of .sk files by the grammar that editors/vscode has: its patterns, tried in order at each place. Of TextMate's rules, those
// are here that the grammar uses: match, begin and end with patterns, include.
import { StreamLanguage } from '@codemirror/language';
import { tags } from '@lezer/highlight';
import grammar from '../../../../editors/vscode/syntaxes/sk.tmLanguage.json';

/** What scopes mean to themes: the first one that a scope begins with. */
const meanings = {
  'comment.line': 'lineComment',
  'comment.block': 'blockComment',
  string: 'string',
  'constant.character': 'escape',
  'constant.numeric': 'number',
  'constant.language': 'bool',
  'keyword.control.directive': 'processingInstruction',
  'keyword.control': 'controlKeyword',
  'keyword.operator': 'operator',
  'storage.type': 'definitionKeyword',
  'storage.modifier': 'modifier',
  'support.type': 'typeName',
  'support.function': 'standard(variableName)',
  'entity.name.function': 'function(variableName)',
  'meta.attribute': 'attributeName',
  'punctuation.definition.stream': 'punctuation',
};

const tokenTable = Object.fromEntries(
  Object.values(meanings).map((name) => {
    const [, modifier, base] = /^(\w+)\((\w+)\)$/.exec(name) ?? [];
    return [name.replace(/\W/g, ' ').trim().replace(' ', '_'), modifier === undefined ? tags[name] : tags[modifier](tags[base])];
  }),
);

function meaningOf(scope) {
  const found = Object.keys(meanings).find((prefix) => scope.startsWith(prefix));
  return found === undefined ? null : meanings[found].replace(/\W/g, ' ').trim().replace(' ', '_');
}

/** A grammar's patterns as a list of rules: { match | begin, end, inner, token }. */
function rulesOf(patterns) {
  return patterns.flatMap((pattern) => {
    if (pattern.include !== undefined) return rulesOf(grammar.repository[pattern.include.slice(1)].patterns);
    const scope = pattern.name ?? pattern.captures?.[1]?.name ?? '';
    const rule = { token: meaningOf(scope), match: new RegExp(pattern.match ?? pattern.begin, 'y') };
    return [pattern.end === undefined ? rule : { ...rule, end: new RegExp(pattern.end, 'y'), inner: rulesOf(pattern.patterns ?? []) }];
  });
}

const rules = rulesOf(grammar.patterns);

/** The length of what a pattern takes at the place of the stream; 0 if it does not fit. */
function lengthAt(stream, pattern) {
  pattern.lastIndex = stream.pos;
  return pattern.exec(stream.string)?.[0].length ?? 0;
}

export const sk = StreamLanguage.define({
  name: 'sk',
  tokenTable,
  startState: () => ({ within: null }),
  copyState: ({ within }) => ({ within }),
  token(stream, state) {
    if (stream.eatSpace()) return null;
    const { within } = state;
    if (within !== null) {
      const ends = lengthAt(stream, within.end);
      if (ends > 0) {
        stream.pos += ends;
        state.within = null;
        return within.token;
      }
    }
    for (const rule of within?.inner ?? rules) {
      const taken = lengthAt(stream, rule.match);
      if (taken === 0) continue;
      stream.pos += taken;
      if (rule.end !== undefined) state.within = rule;
      return rule.token;
    }
    stream.next();
    if (within === null) stream.eatWhile(/\w/);
    return within?.token ?? null;
  },
  languageData: {
    commentTokens: { line: '//', block: { open: '/*', close: '*/' } },
    indentOnInput: /^\s*[}\])]$/,
  },
});
