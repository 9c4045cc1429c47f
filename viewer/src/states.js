// SPDX-License-Identifier: BSD-3-Clause
// What can be shown of the graph. `colour` names a variable of style.css.

export const closureStates = {
  validated: {name: 'Validated', colour: '--validated', width: 2},
  hypothesis: {name: 'Hypothesis, too few votes', short: 'Hypothesis', colour: '--hypothesis', width: 1.6},
  audited_out: {name: 'Audited out', colour: '--audited', width: 1.6},
  rejected_score: {name: 'Rejected, score too low', short: 'Rejected', colour: '--rejected', width: 1},
};

export const stateName = (state) => closureStates[state].short ?? closureStates[state].name;
