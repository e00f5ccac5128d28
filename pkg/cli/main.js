/** From the command line to the exit code: 0 done, 1 failed, 2 usage, 128 + the signal's number when interrupted. */
import { constants } from 'node:os';
import { COMMANDS, parse } from './arguments.js';
import { sentence } from '../files/disk.js';
import { version } from '../files/version.js';
import { help, overview } from './help.js';
import { run } from './run.js';
import { say } from './say.js';
import { UsageError } from './usage.js';

/**
 * @param {string[]} argv without node and the script
 * @returns {Promise<number>}
 */
export async function main(argv) {
  const interrupted = new AbortController();
  /** @param {NodeJS.Signals} name */
  const interrupt = (name) => interrupted.abort(name);
  for (const name of SIGNALS) process.once(name, interrupt); // a second one ends the process at once
  process.stdout.on('error', leaveQuietly);
  try {
    const task = parse(argv);
    if ('version' in task) return await print(`${await version()}\n`);
    if (!('command' in task)) return await print(task.help ? help(task.help) : overview());
    return (await run(task, interrupted.signal)) ? 0 : 1;
  } catch (error) {
    return fail(error, argv, interrupted.signal);
  } finally {
    for (const name of SIGNALS) process.off(name, interrupt);
  }
}

/** @type {NodeJS.Signals[]} */
const SIGNALS = ['SIGINT', 'SIGTERM'];

/** @param {unknown} error @param {string[]} argv @param {AbortSignal} interrupted */
function fail(error, [command], interrupted) {
  if (interrupted.aborted) {
    say('interrupted: nothing unfinished was left behind');
    return 128 + constants.signals[/** @type {NodeJS.Signals} */ (interrupted.reason)];
  }
  if (!(error instanceof UsageError)) {
    say(sentence(error));
    return 1;
  }
  say(`${error.message}\nSee pointweave ${COMMANDS.some((name) => name === command) ? `${command} ` : ''}--help`);
  return 2;
}

/** @param {string} text */
async function print(text) {
  process.stdout.write(text);
  return 0;
}

/** Who reads the output may have enough of it, as `head` has. @param {NodeJS.ErrnoException} error */
function leaveQuietly(error) {
  if (error.code !== 'EPIPE') throw error;
  process.exit();
}
