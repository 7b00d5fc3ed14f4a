// SPDX-License-Identifier: MIT
//
// A textarea with the interface of editor/editor.js, for a build without npm.
export function createEditor(parent, label, changed) {
  const area = document.createElement('textarea');
  area.spellcheck = false;
  area.setAttribute('aria-label', label);
  area.addEventListener('input', changed);
  parent.append(area);
  return {
    text: () => area.value,
    setText(text) {
      area.value = text;
      changed();
    },
    showMessages() {}, // the list below the editor has them
    goTo(line, column) {
      const before = area.value.split('\n').slice(0, Math.max(line, 1) - 1).reduce((sum, text) => sum + text.length + 1, 0);
      const at = Math.min(before + Math.max(column, 1) - 1, area.value.length);
      area.focus();
      area.setSelectionRange(at, at);
    },
  };
}
