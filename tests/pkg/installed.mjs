// The package as it is installed: a copy of its own, with or without its optional peers beside it.

import { cpSync, mkdirSync, mkdtempSync, rmSync, symlinkSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const PACKAGE = fileURLToPath(new URL('../../pkg', import.meta.url));
const INSTALLED = fileURLToPath(new URL('../node_modules', import.meta.url));

export const PEERS = ['@gltf-transform/core', '@gltf-transform/extensions', 'meshoptimizer'];

/**
 * An engine of the package in a project that has these packages too, and where the package is. Both end with the test.
 * @param {import('node:test').TestContext} t
 * @param {string[]} peers
 */
export async function engineBeside(t, peers) {
  const modules = join(mkdtempSync(join(tmpdir(), 'pointweave-peers-')), 'node_modules');
  t.after(() => rmSync(dirname(modules), { recursive: true }));
  cpSync(PACKAGE, join(modules, 'pointweave'), { recursive: true, filter: (path) => !path.includes('node_modules', PACKAGE.length) });
  for (const peer of peers) {
    mkdirSync(dirname(join(modules, peer)), { recursive: true });
    symlinkSync(join(INSTALLED, peer), join(modules, peer));
  }
  const { createEngine } = await import(pathToFileURL(join(modules, 'pointweave/index.node.js')).href);
  const engine = await createEngine({ threads: 1 });
  t.after(() => engine.dispose());
  return { engine, home: pathToFileURL(join(modules, 'pointweave/')).href };
}
