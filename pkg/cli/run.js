/** Does what the command line asks for, one file after the other. */
import { createEngine } from '../index.node.js';
import { compressorFor, encoderFor } from '../files/compressor.js';
import { PointweaveError, toRecord } from '../engine/errors.js';
import { Bar } from './bar.js';
import { withSaid } from './cloud-flags.js';
import { besideOf, checkPlace, levelName, makeFolder, openInput, sameFile, sentence, writeOutput } from '../files/disk.js';
import { LIGHT } from './formats.js';
import { say } from './say.js';
import { stepsOf } from './prepare-flags.js';
import { doubtLines, infoLines, lightLine, pointsOf, reasonLines, reportLine, stepsLine } from './report-text.js';
import { UsageError } from './usage.js';

/** @import { Engine } from '../types.js' */
/** @import { Job, Task } from './arguments.js' */

/** @typedef {{ report: object, text: string, doubts: string[] }} Result */
/** @typedef {Task & { steps: import('../types.js').Step[] }} Whole a task with the steps of its recipe */
/** @typedef {Job & (Result | { error: unknown })} Outcome */

/**
 * @param {Task} task
 * @param {AbortSignal} signal
 * @returns {Promise<boolean>} whether all of it was done
 */
export async function run(task, signal) {
  if (task.catalogue) return (await import('./catalogue.js')).catalogue(task, task.catalogue, signal);
  if (task.tiles) return (await import('./tiles.js')).tiles(task, task.tiles, signal);
  await checkOutputs(task.jobs);
  const steps = await stepsOf(task.prepare);
  // That packages are missing is known before the work.
  await compressorFor(task.write.meshopt);
  await encoderFor(task.write.pictures);
  if (task.folder) await makeFolder(task.folder);
  // A worker in any case: this thread has to hear Ctrl-C.
  const engine = await createEngine({ threads: task.threads, worker: true });
  /** @type {Outcome[]} */
  const outcomes = [];
  try {
    for (const job of task.jobs) {
      const outcome = await attempt(engine, { ...task, steps }, job, outcomes.length, signal);
      signal.throwIfAborted();
      outcomes.push(outcome);
      tell(task, outcome);
    }
  } finally {
    await engine.dispose();
  }
  const failed = outcomes.filter((outcome) => 'error' in outcome).length;
  if (task.json) printJson(outcomes);
  if (outcomes.length > 1) say(`${outcomes.length - failed} of ${outcomes.length} files done${failed ? `, ${failed} failed` : ''}`);
  return failed === 0;
}

/**
 * No result may take the place of a scan.
 * @param {Job[]} jobs
 */
async function checkOutputs(jobs) {
  for (const { output } of jobs) {
    if (output === undefined || output === '-') continue;
    for (const input of jobs.flatMap(({ input, inputs = [input] }) => inputs)) {
      if (await sameFile(input, output)) throw new UsageError(`'${output}' is the scan itself: a result does not overwrite it`);
    }
  }
}

/**
 * @param {Engine} engine
 * @param {Whole} task
 * @param {Job} job
 * @param {number} done
 * @param {AbortSignal} signal
 * @returns {Promise<Outcome>}
 */
async function attempt(engine, task, job, done, signal) {
  const bar = new Bar(process.stderr, task.jobs.length > 1 ? `${done + 1}/${task.jobs.length} ${job.input}` : job.input);
  try {
    return { ...job, ...(await perform(engine, task, job, { signal, onProgress: (progress) => bar.update(progress) })) };
  } catch (error) {
    return { ...job, error };
  } finally {
    bar.clear();
  }
}

/**
 * @param {Engine} engine
 * @param {Whole} task
 * @param {Job} job
 * @param {{ signal: AbortSignal, onProgress: (progress: import('../types.js').Progress) => void }} watch
 * @returns {Promise<Result>}
 */
async function perform(engine, task, job, watch) {
  const { command, cloud: said, own, steps } = task;
  const { input, inputs = [input], output } = job;
  if (output !== undefined && output !== '-') await checkPlace(output);
  const clouds = [];
  for (const name of inputs) clouds.push(await scanOf(engine, task, name, watch));
  const [cloud] = clouds;
  if (command === 'inspect') {
    const info = await engine.inspect(cloud, watch);
    return { report: { ...info, skipped: cloud.skipped, columns: cloud.columns, file: cloud.file }, text: infoLines(info, cloud), doubts: [] };
  }
  if (command === 'prepare' || command === 'merge') {
    const count = clouds.reduce((sum, { positions }) => sum + positions.length / 3, 0);
    const prepared = await engine.prepare(clouds.map((each) => withSaid(each, said)), steps, { ...watch, transfer: true });
    await save(engine, task, output, prepared.cloud, watch);
    const report = { inputPoints: count, outputPoints: prepared.kept.length, steps: told(prepared.steps) };
    return { report, text: stepsLine(count, prepared.steps), doubts: reasonLines(prepared.steps, inputs) };
  }
  if (command === 'poster') {
    const picture = await engine.poster(withSaid(cloud, said), { ...own, ...watch, transfer: true });
    await keep(output, picture.data, watch);
    const { width, height, data: { length } } = picture;
    return { report: { width, height, bytes: length }, text: `${width} × ${height} pixels, ${length} bytes`, doubts: [] };
  }
  if (command === 'simplify') {
    const { indices } = cloud;
    if (!indices) throw new PointweaveError({ code: 'needs-triangles', message: 'the file has no triangles: reconstruct makes a mesh of points' });
    const mesh = await engine.simplify({ ...withSaid(cloud, said), indices }, { ...own, ...watch, transfer: true });
    await save(engine, task, output, mesh, watch);
    const { simplified } = mesh.report;
    return { report: simplified, text: lightLine(simplified), doubts: simplified.reason ? [simplified.reason] : [] };
  }
  const prepare = steps.length > 0 ? { prepare: steps } : {};
  const result = await engine[command === 'reduce' ? command : 'reconstruct'](withSaid(cloud, said), { ...own, ...prepare, ...watch, transfer: true });
  await save(engine, task, output, result, watch);
  for (const [i, level] of (('lods' in result && result.lods) || []).entries()) await save(engine, task, output && levelName(output, i + 1), level, watch);
  const { report, prepared } = result;
  const before = prepared ? `${stepsLine(prepared.labels.length, prepared.steps)}; ` : '';
  const reasons = prepared ? reasonLines(prepared.steps) : [];
  return { report: prepared ? { ...report, steps: told(prepared.steps) } : report, text: before + reportLine(report, cloud), doubts: [...reasons, ...doubtLines(report)] };
}

/**
 * @param {Engine} engine
 * @param {Task} task
 * @param {string} input
 * @param {{ signal: AbortSignal, onProgress: (progress: import('../types.js').Progress) => void }} watch
 */
async function scanOf(engine, { command, read }, input, watch) {
  const name = input === '-' ? undefined : input;
  const file = await openInput(input, watch.signal);
  const whole = LIGHT.includes(command) && { faces: /** @type {const} */ ('mesh') };
  const cloud = await engine.read(file, { name, beside: besideOf(input), ...whole, ...read, ...watch, transfer: true });
  if (cloud.positions.length === 0 && cloud.file.dropped > 0) {
    throw new PointweaveError({ code: 'empty-cloud', message: `the file has ${pointsOf(cloud.file.dropped)}, none of them finite` });
  }
  return cloud;
}

/**
 * @param {Engine} engine
 * @param {Task} task
 * @param {string | undefined} output
 * @param {any} result
 * @param {{ signal: AbortSignal }} watch
 */
async function save(engine, { write, format }, output, result, { signal }) {
  if (output === undefined) return;
  const bytes = await engine.write(result, { ...write, format: /** @type {any} */ (format), signal, transfer: true });
  await keep(output, bytes, { signal });
}

/** @param {string | undefined} output @param {Uint8Array} bytes @param {{ signal: AbortSignal }} watch */
async function keep(output, bytes, { signal }) {
  if (output === '-') await print(bytes);
  else if (output !== undefined) await writeOutput(output, bytes, signal);
}

/** Reports without a label for every point. @param {import('../types.js').StepReport[]} steps */
function told(steps) {
  return steps.map(({ labels, ...step }) => step);
}

/** @param {Task} task @param {Outcome} outcome */
function tell({ command, json }, outcome) {
  const input = outcome.input === '-' ? 'standard input' : outcome.input;
  const output = outcome.output === '-' ? 'standard output' : outcome.output;
  if ('error' in outcome) say(`${input}: ${sentence(outcome.error)}`);
  else if (json) return;
  else if (command === 'inspect') process.stdout.write(`${input}\n${outcome.text}`);
  else [`${input} → ${output}: ${outcome.text}`, ...outcome.doubts.map((doubt) => `${input}: ${doubt}`)].forEach(say);
}

/**
 * The report of one file alone, or an array with one entry a file. A single failure has its line, and nothing else.
 * @param {Outcome[]} outcomes
 */
function printJson(outcomes) {
  const entries = outcomes.map((outcome) => {
    const { input, output } = outcome;
    return 'error' in outcome ? { input, error: errorEntry(outcome.error) } : { input, output, report: outcome.report };
  });
  const [only] = entries;
  const value = entries.length > 1 ? entries : only.report;
  if (value) process.stdout.write(`${JSON.stringify(value, null, 2)}\n`);
}

/** @param {unknown} error of this package, with all it says, or of the system with its code */
function errorEntry(error) {
  return error instanceof PointweaveError ? toRecord(error) : { code: /** @type {any} */ (error)?.code ?? 'internal', message: sentence(error) };
}

/** @param {Uint8Array} bytes @returns {Promise<void>} */
function print(bytes) {
  return new Promise((resolve, reject) => process.stdout.write(bytes, (error) => (error ? reject(error) : resolve())));
}
