/** What the package adds to a report. */

/** @import { Build } from '../types.js' */

/**
 * Says in the reports of a result what has computed it.
 * @param {any} value what a call gave, with or without reports
 * @param {{ build: Build, threads: number, reason: string }} by
 */
export function signed(value, { build, threads, reason }) {
  for (const report of [value.report, value.cloud?.report]) {
    if (report) Object.assign(report, { build, threads, reason: [reason, report.reason].filter(Boolean).join('; ') });
  }
  return value;
}
