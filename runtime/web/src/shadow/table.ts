// SPDX-License-Identifier: MIT
//
// A report as text, for the console. No GL: Node tests it.
import type { ReportNumber, ShadowReport } from './report.js';

function error(value: ReportNumber | undefined): string {
  if (value === undefined) return '';
  return value === 0 ? '0' : typeof value === 'number' ? value.toExponential(1) : value;
}

/** Columns of equal width; the first one is left-aligned. */
function columns(rows: readonly (readonly string[])[]): string[] {
  const widths = rows[0]!.map((_, c) => Math.max(...rows.map((row) => row[c]!.length)));
  return rows.map((row) => row.map((cell, c) => (c === 0 ? cell.padEnd(widths[c]!) : cell.padStart(widths[c]!))).join('  ').trimEnd());
}

export function tableOf(report: ShadowReport): string {
  const kernels = [...report.kernels].sort((a, b) => Number(b.share) - Number(a.share));
  const byKernel = kernels.map(({ name, calls, own, inherited, total, amplification, digits, share }) => [
    name, String(calls), error(own.largest), error(inherited.largest), error(total.largest), error(amplification?.typical), digits.toFixed(1),
    typeof share === 'number' ? `${(100 * share).toFixed(0)} %` : share,
  ]);
  const byResult = report.results.map((result) => [result.name, String(result.reads), error(result.error.largest), result.digits.toFixed(1), String(result.differs)]);
  const lines = report.verdicts.map(({ text }) => text);
  if (byKernel.length > 0) lines.push('', ...columns([['kernel', 'calls', 'own', 'inherited', 'total', 'growth', 'digits', 'share'], ...byKernel]));
  if (byResult.length > 0) lines.push('', ...columns([['result', 'reads', 'error', 'digits', 'differ'], ...byResult]));
  if (report.notes.length > 0) lines.push('', ...report.notes.map((note) => `note: ${note}`));
  return `${lines.join('\n')}\n`;
}
