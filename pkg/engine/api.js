/** The package's functions over one platform: `index.js` and `index.node.js` export them. */
import { Engine } from './engine.js';

/**
 * @param {import('./engine.js').Platform} platform
 * @returns {Pick<typeof import('../types.js'), 'createEngine' | 'prepare' | 'simplify' | 'texture' | 'poster' | 'reduce' | 'reconstruct' | 'inspect' | 'read' | 'write' | 'sample'>}
 */
export function makeApi(platform) {
  /** Made on the first call of a function that takes no engine. @type {Engine | undefined} */
  let shared;
  const engine = () => (shared ??= new Engine(platform));

  return {
    async createEngine(options) {
      const made = new Engine(platform, options);
      await made.ready();
      return made;
    },
    prepare: (cloud, steps, options) => engine().prepare(cloud, steps, options),
    simplify: (mesh, options) => engine().simplify(mesh, options),
    texture: (mesh, cloud, options) => engine().texture(mesh, cloud, options),
    poster: (what, options) => engine().poster(what, options),
    reduce: (cloud, options) => engine().reduce(cloud, options),
    reconstruct: (cloud, options) => engine().reconstruct(cloud, options),
    inspect: (cloud, options) => engine().inspect(cloud, options),
    read: (data, options) => engine().read(data, options),
    write: (result, options) => engine().write(result, options),
    sample: (model, options) => engine().sample(model, options),
  };
}
