// SPDX-License-Identifier: BSD-3-Clause

const rounded = (value, digits) => Number(value.toFixed(digits));

/** The line of edits.yaml (docs/map_file.md) that would turn the decision on a closure over. */
export function editLine(attempt) {
  const pair = `from: ${attempt.tA}, to: ${attempt.tB}`;
  if (attempt.state === 'validated') return `- forbid_closure: {${pair}}`;
  const pose = [rounded(attempt.dx, 3), rounded(attempt.dy, 3), rounded(attempt.dtheta * 180 / Math.PI, 2)];
  // What was rejected by its score has no match: the two scans are matched anew, near the guess.
  const kind = attempt.state === 'rejected_score' ? 'guess' : 'transform';
  return `- add_closure: {${pair}, ${kind}: [${pose.join(', ')}]}`;
}
