/** Words for people, beside what goes to standard output. @param {string} line */
export function say(line) {
  process.stderr.write(`pointweave: ${line}\n`);
}
