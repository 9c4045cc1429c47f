// SPDX-License-Identifier: BSD-3-Clause

const rounded = (value, digits) => Number(value.toFixed(digits));

/** The line of edits.yaml that would turn the decision on a closure over. */
export function editLine(attempt) {
  const pair = `t_a: ${attempt.tA}, t_b: ${attempt.tB}`;
  if (attempt.state === 'validated') return `forbid: [{${pair}}]`;
  return `add: [{${pair}, dx: ${rounded(attempt.dx, 3)}, dy: ${rounded(attempt.dy, 3)}, ` +
      `dtheta_deg: ${rounded(attempt.dtheta * 180 / Math.PI, 2)}}]`;
}
