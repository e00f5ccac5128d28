/** All tasks of a plan on this machine, as many at a time as there are workers. */
import { Worker } from 'node:worker_threads';
import { PointweaveError } from '../engine/errors.js';
import { STAGES } from './plan.js';

/** @import { Folder } from './folder.js' */
/** @import { PlannedTask } from './plan.js' */

/**
 * What a worker is asked to do: a stage, and of `count` and `sort` where the input lies.
 * @typedef {{ stage: import('./plan.js').Stage | 'count', tile?: string, input?: string, read?: Record<string, any>, part?: import('./parts.js').Part }} Work
 */

/** Does one thing at a time; each of them ends with it. */
export class Workers {
  /** @type {Worker[]} */
  #idle = [];
  /** @type {Set<Worker>} */
  #all = new Set();

  /** @param {Folder} folder @param {number} most @param {{ memory: number, costOf: (stage: string) => number }} room bytes that all may take together, and a task of each stage */
  constructor(folder, most, room) {
    this.folder = folder;
    this.most = most;
    this.room = room;
  }

  /** @param {Work} work @returns {Promise<void>} */
  async run(work) {
    const { signal, path } = this.folder;
    signal.throwIfAborted();
    const worker = this.#idle.pop() ?? this.#start();
    await new Promise((resolve, reject) => {
      const abort = () => settle(() => reject(signal.reason));
      /** @param {{ error?: any }} answer */
      const answered = ({ error }) => settle(() => (error ? reject(errorOf(error)) : resolve(undefined)));
      const failed = (/** @type {Error} */ error) => settle(() => reject(error));
      const ended = (/** @type {number} */ code) => failed(new PointweaveError({ code: 'internal', message: `a worker ended with ${code}` }));
      /** @param {() => void} then */
      const settle = (then) => {
        worker.off('message', answered).off('error', failed).off('exit', ended);
        signal.removeEventListener('abort', abort);
        then();
      };
      worker.on('message', answered).on('error', failed).on('exit', ended);
      signal.addEventListener('abort', abort);
      worker.postMessage({ path, ...work });
    });
    this.#idle.push(worker);
  }

  #start() {
    const worker = new Worker(new URL('./worker.js', import.meta.url), { name: 'pointweave tiles', execArgv: [] });
    this.#all.add(worker);
    return worker;
  }

  async end() {
    await Promise.all([...this.#all].map((worker) => worker.terminate()));
  }
}

/** @param {any} record as `worker.js` made it */
function errorOf(record) {
  return record.system ? Object.assign(new Error(record.message), { code: record.code }) : new PointweaveError(record);
}

/**
 * Runs the tasks of which something is missing. One that fails ends all; what was made stays.
 * @param {Workers} workers
 * @param {PlannedTask[]} tasks
 * @param {string[]} inputs where each lies
 * @param {(task: PlannedTask, done: number, all: number) => void} tell after each
 */
export async function runAll(workers, tasks, inputs, tell) {
  const { folder } = workers;
  /** @type {Set<string>} */
  const there = new Set();
  for (const name of new Set(tasks.flatMap(({ needs, makes }) => [...needs, ...makes]))) if (await folder.has(name)) there.add(name);
  const missing = tasks.filter(({ makes }) => !makes.every((name) => there.has(name)));
  for (const { makes } of missing) for (const name of makes) there.delete(name);
  // Of a stage the heaviest first: no large one is left to the end, when all others are done.
  const order = (/** @type {PlannedTask} */ { stage }) => STAGES.indexOf(stage);
  const waiting = missing.toSorted((a, b) => order(a) - order(b) || (b.weight ?? 0) - (a.weight ?? 0));
  /** @type {Set<Promise<void>>} */
  const running = new Set();
  const { memory, costOf } = workers.room;
  let taken = 0;
  let done = 0;
  /** @type {unknown} */
  let failed;
  /** @param {PlannedTask} task */
  const start = (task) => {
    waiting.splice(waiting.indexOf(task), 1);
    const { stage, tile, input } = task;
    const work = workers.run({ stage, tile, input: input === undefined ? undefined : inputs[input] }).then(
      () => {
        for (const name of task.makes) there.add(name);
        tell(task, ++done, missing.length);
      },
      (error) => void (failed ??= { error }),
    );
    taken += costOf(stage);
    const ended = work.finally(() => {
      taken -= costOf(stage);
      running.delete(ended);
    });
    running.add(ended);
  };
  while (!failed && (waiting.length > 0 || running.size > 0)) {
    const mayRun = (/** @type {PlannedTask} */ { stage, needs }) => taken + costOf(stage) <= memory && needs.every((name) => there.has(name));
    for (let task; !failed && running.size < workers.most && (task = waiting.find(mayRun)); ) start(task);
    if (running.size === 0) throw new PointweaveError({ code: 'internal', message: `nothing makes what ${waiting[0].id} needs` });
    await Promise.race(running);
  }
  await Promise.all(running);
  if (failed) throw /** @type {{ error: unknown }} */ (failed).error;
}
