/** One step by its name. */
import * as steps from './steps.js';

/** @param {import('./folder.js').Folder} folder @param {import('./schedule.js').Work} work */
export async function runStep(folder, { stage, tile = '', input = '', read = {}, part }) {
  switch (stage) {
    case 'count': return steps.count(folder, Number(tile), input, { read, part });
    case 'sort': return steps.sort(folder, Number(tile), input);
    case 'measure': return steps.measure(folder, tile);
    case 'density': return steps.density(folder);
    case 'make': return steps.make(folder, tile);
    case 'level': return steps.level(folder, tile);
    case 'mesh': return steps.mesh(folder, Number(tile));
    case 'finish': return steps.finish(folder);
  }
}
